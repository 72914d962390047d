#include "methods/core/registry.hpp"
#include "methods/core/taylor_fit.hpp"

namespace strongpoint {

/// Modified Finite Particle Method, novel formulation. With the thesis' projection functions (the
/// monomials) it is the unweighted least-squares Taylor fit with the value at the centre
/// eliminated. Source: Asprone, Auricchio, Montanino, Reali 2014; thesis 3.2, sign in (3.27)
/// corrected.
MethodEntry method_mfpm() {
  return {{"mfpm",
           "Modified Finite Particle Method, novel formulation: unweighted Taylor fit",
           {{"order", "2", "highest derivative of the Taylor series, 1 to 8"}}},
          in_every_dimension<Method>([]<int Dim>(Dimension<Dim>, Options& options) {
            const int order = options.integer("order", 1, 8);
            return make_taylor_method<Dim>("mfpm", order, make_weight("one").made,
                                           lean_surplus(order), default_lean_stencil(Dim, order));
          })};
}

}  // namespace strongpoint
