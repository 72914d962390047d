#pragma once

#include <array>
#include <vector>

#include "methods/core/projection_fit.hpp"
#include "methods/core/radial_derivative.hpp"
#include "methods/core/stencil_kernel.hpp"

namespace strongpoint {

/// Projections on a smoothing kernel and its derivatives, V_j (D^a W)(x_j - x_i): one function for
/// each derivative, in units of the smoothing length. Source: thesis (1.17), (1.18), (1.20),
/// (1.21).
template <int Dim>
Projections<Dim> kernel_projections(const StencilKernel<Dim>& kernel,
                                    const Derivatives<Dim>& derivatives) {
  std::vector<RadialDerivative<Dim>> radial;
  for (const MultiIndex<Dim>& alpha : derivatives) radial.emplace_back(alpha);
  const int order = derivatives.highest_order();
  return [kernel, radial, order](const LocalStencil<Dim>& stencil, double* values) {
    std::array<double, most_smoothness + 1> f{};
    const double length = kernel.length(stencil);
    for (int j = 0; j < stencil.size; ++j) {
      const Point<Dim> q = stencil.node(j) / length;
      kernel.kernel().evaluate(q.squaredNorm(), order, f.data());
      for (const RadialDerivative<Dim>& derivative : radial) {
        *values++ = stencil.volumes[j] * derivative(q, f.data());
      }
    }
  };
}

/// Makes a method that projects the Taylor series up to order 2, in blocks, on a smoothing kernel
/// and its derivatives of the same orders. `name` is used in messages.
template <int Dim>
std::unique_ptr<Method<Dim>> make_kernel_projection_method(
    std::string name, const std::vector<Derivatives<Dim>>& blocks, const StencilKernel<Dim>& kernel,
    Promises promises) {
  Derivatives<Dim> terms;
  for (const Derivatives<Dim>& block : blocks) terms.merge(block);
  ProjectionFit<Dim> fit(blocks, kernel_projections(kernel, terms), kernel.profile());
  const Needs needs{.volumes = true, .spacing = true, .centre = fit.needs_centre()};
  return std::make_unique<ProjectionMethod<Dim>>(
      std::move(fit), typename ProjectionMethod<Dim>::Traits{std::move(name), promises, needs,
                                                             StencilKernel<Dim>::least_nodes,
                                                             kernel.default_stencil()});
}

}  // namespace strongpoint
