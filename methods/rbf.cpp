#include "methods/core/radial_interpolation.hpp"
#include "methods/core/registry.hpp"

namespace strongpoint {

/// Radial basis functions without polynomials, collocated on the nearest nodes. Source: Kansa 1990,
/// thesis 1.3.2, made local as in Lee, Liu, Fan 2003. Tied to the spacing, the shape parameter
/// keeps the condition and loses convergence (constants are not reproduced, so that derivatives of
/// order q err by h^-q); with a fixed length the condition grows as the spacing falls.
MethodEntry method_rbf() {
  return {{"rbf", "radial basis functions on local stencils, without polynomials",
           radial_options("mq")},
          in_every_dimension<Method>([]<int Dim>(Dimension<Dim>, Options& options) {
            return make_radial_method<Dim>("rbf", options, -1);
          })};
}

}  // namespace strongpoint
