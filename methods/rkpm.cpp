#include "methods/core/moving_fit.hpp"
#include "methods/core/registry.hpp"

namespace strongpoint {

/// Reproducing kernel particle method: the kernel times a polynomial that corrects it, summed with
/// the volumes of the nodes' cells, so that polynomials are reproduced. Full derivatives of the
/// shape functions.
/// Source: Liu, Jun, Zhang 1995; thesis 1.2.1. Deviations: the thesis leaves derivatives to (1.6)
/// and (1.7), derivatives of the uncorrected kernel, which reproduce nothing; order 2 is its
/// (1.15). On cells of equal volume these are the shape functions of `mls`.
MethodEntry method_rkpm() {
  return {{"rkpm",
           "reproducing kernel particle method: corrected kernels and cell volumes",
           {{"order", "2", "1 or 2: degree of the polynomials that are reproduced"},
            SmoothingKernel::kernel_option("quartic_spline"),
            suitable_length_option()}},
          in_every_dimension<Method>([]<int Dim>(Dimension<Dim>, Options& options) {
            const int order = options.integer("order", 1, 2);
            return make_moving_method<Dim>(
                "rkpm",
                MovingFit<Dim>(order, StencilKernel<Dim>(options, suitable_support(Dim, order)),
                               Differentiation::full, NodeMeasure::volume));
          })};
}

}  // namespace strongpoint
