#pragma once

#include <span>

#include "methods/core/derivatives.hpp"
#include "methods/core/sites.hpp"
#include "methods/core/stencils.hpp"

namespace strongpoint {

/// Some anchors whose stencils a kernel may treat side by side.
template <int Dim>
struct StencilBatch {
  const Sites<Dim>& sites;
  const Stencils& stencils;
  const Stencils& points;  ///< evaluation points of each anchor
  const Derivatives<Dim>& derivatives;
  std::span<const int> anchors;  ///< none with an empty stencil
};

}  // namespace strongpoint
