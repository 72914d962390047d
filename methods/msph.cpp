#include "methods/core/kernel_projections.hpp"
#include "methods/core/registry.hpp"

namespace strongpoint {

/// Modified Smoothed Particle Hydrodynamics of second order: value, first and second derivatives at
/// once from the Taylor series projected on the kernel and its derivatives. Source: Zhang & Batra
/// 2004; thesis (1.19)-(1.21), which write down the first order.
MethodEntry method_msph() {
  return {{"msph",
           "Modified Smoothed Particle Hydrodynamics: projections on the kernel's derivatives",
           {SmoothingKernel::kernel_option("gauss"), SmoothingKernel::length_option("1.2")}},
          in_every_dimension<Method>([]<int Dim>(Dimension<Dim>, Options& options) {
            return make_kernel_projection_method<Dim>(
                "msph", {Derivatives<Dim>::between_orders(0, 2)}, StencilKernel<Dim>(options),
                {.reproduces = 2, .interpolates = false});
          })};
}

}  // namespace strongpoint
