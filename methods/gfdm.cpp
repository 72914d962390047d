#include "methods/core/registry.hpp"
#include "methods/core/taylor_fit.hpp"

namespace strongpoint {

/// Generalized Finite Difference Method: Taylor fit on the nodes of the star criterion.
/// Source: Benito, Urena, Gavete 2001; thesis 1.4.1, signs in (1.59) corrected: the residual is
/// u_j - u_i - Taylor terms. The thesis states no weight; T = r^-3 is the default here.
/// In 3D two nodes an octant can lie on two planes at the faces of a grid; such stars are grown.
MethodEntry method_gfdm() {
  return {{"gfdm",
           "Generalized Finite Difference Method: weighted Taylor fit on a star",
           {{"order", "2", "highest derivative of the Taylor series, 1 to 8"},
            {"weight", "inverse_cube", "weight on the residual, any of the weights listed"}}},
          in_every_dimension<Method>([]<int Dim>(Dimension<Dim>, Options& options) {
            const NamedWeight weight = make_weight(options.text("weight"));
            options.set("weight", weight.spec);
            const int order = options.integer("order", 1, 8);
            return make_taylor_method<Dim>("gfdm", order, weight.made, lean_surplus(order),
                                           order != 2 ? "nearest"
                                           : Dim == 3 ? "grow_until[of=star]"
                                                      : "star");
          })};
}

}  // namespace strongpoint
