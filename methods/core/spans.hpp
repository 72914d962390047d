#pragma once

#include <stdexcept>
#include <string>

#include "methods/core/method.hpp"

namespace strongpoint {

/// Weights of every evaluation point by any method: `Method::weights`, or, where points have spans
/// that the method does not read, the means of its weights at both ends of each span.
template <int Dim>
Weights weights_on(const Method<Dim>& method, const Sites<Dim>& sites, const Stencils& stencils,
                   const Derivatives<Dim>& derivatives);

/// Throws std::logic_error, naming the method, when points have spans, which it does not read.
template <int Dim>
void refuse_spans(const Sites<Dim>& sites, const std::string& method) {
  if (sites.spans.cols() == 0) return;
  throw std::logic_error(method + " reads no spans of points; call weights_on");
}

}  // namespace strongpoint
