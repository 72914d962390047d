#include "methods/core/registry.hpp"
#include "methods/core/taylor_fit.hpp"

namespace strongpoint {

/// Least-Square-based Finite Difference method: Taylor fit on generous stencils with a bell-shaped
/// weight. Source: Ding, Shu, Yeo, Xu 2004.
MethodEntry method_lsfdm() {
  return {{"lsfdm",
           "Least-Square-based Finite Difference method: bell-weighted Taylor fit",
           {{"order", "2", "highest derivative of the Taylor series, 1 to 8"},
            {"weight", "bump4", "weight on the residual, any of the weights listed"}}},
          in_every_dimension<Method>([]<int Dim>(Dimension<Dim>, Options& options) {
            const NamedWeight weight = make_weight(options.text("weight"));
            options.set("weight", weight.spec);
            return make_taylor_method<Dim>("lsfdm", options.integer("order", 1, 8), weight.made,
                                           {5.0 / 3, 2.5, 3}, "nearest");
          })};
}

}  // namespace strongpoint
