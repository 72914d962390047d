#include "methods/core/kernel_projections.hpp"
#include "methods/core/registry.hpp"

namespace strongpoint {
namespace {

enum class Value { nodal, kernel };

}  // namespace

/// Corrective Smoothed Particle Method: the Taylor series projected on the kernel's derivatives,
/// first derivatives before second ones. Source: Chen, Beraun, Carney 1999, in all dimensions;
/// thesis (1.17), (1.18), where f(x_i) is the nodal value. Exact for linear functions; second
/// derivatives of quadratic ones only where the first ones are, in the middle of symmetric
/// stencils.
MethodEntry method_cspm() {
  return {
      {"cspm",
       "Corrective Smoothed Particle Method: projections on the kernel's derivatives, in turn",
       {SmoothingKernel::kernel_option("gauss"),
        SmoothingKernel::length_option("1.2"),
        {"value", "nodal", "nodal | kernel: the value at a node, given or estimated by (1.17)"}}},
      in_every_dimension<Method>([]<int Dim>(Dimension<Dim>, Options& options) {
        std::vector<Derivatives<Dim>> blocks;
        Promises promises{.reproduces = 1};
        if (options.choice<Value>("value", {{"nodal", Value::nodal}, {"kernel", Value::kernel}}) ==
            Value::kernel) {
          blocks.push_back(Derivatives<Dim>::between_orders(0, 0));
          promises = {.reproduces = 0, .interpolates = false};  // (1.17) is exact for constants
        }
        blocks.push_back(Derivatives<Dim>::between_orders(1, 1));
        blocks.push_back(Derivatives<Dim>::between_orders(2, 2));
        return make_kernel_projection_method<Dim>("cspm", blocks, StencilKernel<Dim>(options),
                                                  promises);
      })};
}

}  // namespace strongpoint
