#include "methods/core/polynomial_fit.hpp"
#include "methods/core/registry.hpp"

namespace strongpoint {

/// Modified Finite Particle Method, extended formulation: the value at the centre is unknown too,
/// so that centres may lie apart from nodes. With the thesis' projection functions (the monomials)
/// it is the unweighted least-squares fit of a polynomial. Source: thesis 7.1, (7.1)-(7.11). On a
/// 3x3 block its Laplacian is not elliptic: it is meant for more centres than nodes.
MethodEntry method_mfpm_extended() {
  return {{"mfpm_extended",
           "Modified Finite Particle Method, extended formulation: unweighted fit, value unknown",
           {{"order", "2", "degree of the Taylor polynomial, 1 to 8"}}},
          in_every_dimension<Method>([]<int Dim>(Dimension<Dim>, Options& options) {
            return make_polynomial_method<Dim>("mfpm_extended", options.integer("order", 1, 8),
                                               make_weight("one").made, {2, 2, 2});
          })};
}

}  // namespace strongpoint
