#pragma once

#include "methods/core/method.hpp"

namespace strongpoint {

/// Weights of every evaluation point by any method: `Method::weights`, or, where points have spans
/// that the method does not read, the means of its weights at both ends of each span.
template <int Dim>
Weights weights_on(const Method<Dim>& method, const Sites<Dim>& sites, const Stencils& stencils,
                   const Derivatives<Dim>& derivatives);

}  // namespace strongpoint
