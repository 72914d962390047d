#include "methods/core/polynomial_fit.hpp"
#include "methods/core/registry.hpp"

namespace strongpoint {

/// Generalised moving least squares: derivatives are estimated directly, as those of the local
/// polynomial, instead of differentiating shape functions. The value is unknown: nodal parameters
/// are not values. Source: Mirzaei, Schaback, Dehghan 2012. Deviations: the weight is spread over
/// the stencil, whose nodes are counted, instead of over a ball of given radius; the default weight
/// grows towards the centre. With the source's bells the centre has so little say that collocation
/// is erratic (plate_hole on perturbed nodes); T^2 = r^-4 almost passes through its value.
MethodEntry method_gmls() {
  return {{"gmls",
           "generalised moving least squares: weighted polynomial fit, value unknown",
           {{"degree", "2", "degree of the polynomials, 1 to 8"},
            {"weight", "power",
             "weight on the residual, any of the weights listed; powers of 1/r are finite at the "
             "centre: as at a tenth of the stencil radius"}}},
          in_every_dimension<Method>([]<int Dim>(Dimension<Dim>, Options& options) {
            const NamedWeight weight = make_weight(options.text("weight"));
            options.set("weight", weight.spec);
            return make_polynomial_method<Dim>("gmls", options.integer("degree", 1, 8), weight.made,
                                               {2, 2.5, 2.5});
          })};
}

}  // namespace strongpoint
