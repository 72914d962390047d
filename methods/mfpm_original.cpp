#include "methods/core/registry.hpp"
#include "methods/core/taylor_fit.hpp"

namespace strongpoint {

/// Modified Finite Particle Method, original formulation: the projections are integrals, summed
/// with the measures of the Voronoi cells, so each residual weighs its node's cell. Source:
/// Asprone, Auricchio, Reali 2011; thesis 3.1, sum over j in (3.6).
MethodEntry method_mfpm_original() {
  return {
      {"mfpm_original",
       "Modified Finite Particle Method, original formulation: Taylor fit weighted by cell volumes",
       {{"order", "2", "highest derivative of the Taylor series, 1 to 8"}}},
      in_every_dimension<Method>([]<int Dim>(Dimension<Dim>, Options& options) {
        const int order = options.integer("order", 1, 8);
        return make_taylor_method<Dim>("mfpm_original", order, make_weight("volume").made,
                                       lean_surplus(order), default_lean_stencil(Dim, order));
      })};
}

}  // namespace strongpoint
