#include "methods/core/taylor_fit.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "methods/core/error.hpp"
#include "methods/core/stencil_size.hpp"

namespace strongpoint {
namespace {

/// Smallest pivot over diagonal of the normal equations that still leaves about eleven digits;
/// below it the weighted Vandermonde matrix is factorised instead.
constexpr double pivot_tolerance = 1e-4;
/// Limits of the normal equations that are solved side by side and refined: half the digits of the
/// factor are left, which one step of refinement makes full.
constexpr TaylorLimits batch_limits{1e-7, 1e8};
/// From this order on the normal equations always lose too many digits.
constexpr int first_order_by_qr = 5;

}  // namespace

template <int Dim>
TaylorFit<Dim>::TaylorFit(int order, std::shared_ptr<const WeightFunction> weight)
    : basis_(1, order), weight_(std::move(weight)) {
  if (order < 1 || order > 8) {
    throw UsageError(
        fmt::format("a Taylor fit of order {} is not offered; allowed: 1 to 8", order));
  }
}

template <int Dim>
void TaylorFit<Dim>::evaluate_weights(const LocalStencil<Dim>& stencil,
                                      std::vector<double>& squared) const {
  squared.resize(stencil.size);
  if (weight_->uses_volumes()) {
    std::copy(stencil.volumes.begin(), stencil.volumes.end(), squared.begin());
  } else {
    weight_->squared({stencil.rho.data(), stencil.rho.data() + stencil.size}, squared);
  }
  squared[stencil.centre] = 0;  // its residual is zero whatever the weight
}

template <int Dim>
bool TaylorFit<Dim>::factorise_normal_equations(const LocalStencil<Dim>& stencil,
                                                Workspace& work) const {
  const int m = unknowns();
  double* moments = work.normal_equations.prepare(m);
  std::fill(moments, moments + static_cast<std::ptrdiff_t>(m) * m, 0.0);
  for (int j = 0; j < stencil.size; ++j) {
    const double* basis = work.basis.data() + static_cast<std::ptrdiff_t>(j) * m;
    for (int a = 0; a < m; ++a) {
      const double scaled = work.squared[j] * basis[a];
      for (int b = 0; b <= a; ++b) moments[a * m + b] += scaled * basis[b];
    }
  }
  return work.normal_equations.factorise(pivot_tolerance);
}

template <int Dim>
bool TaylorFit<Dim>::factorise_qr(const LocalStencil<Dim>& stencil, Workspace& work) const {
  const int m = unknowns();
  double* matrix = work.qr.prepare(stencil.size, m);
  for (int j = 0; j < stencil.size; ++j) {
    const double weight = std::sqrt(work.squared[j]);
    for (int a = 0; a < m; ++a) {
      matrix[static_cast<std::ptrdiff_t>(a) * stencil.size + j] =
          weight * work.basis[static_cast<std::size_t>(j) * m + a];
    }
  }
  return work.qr.factorise(rank_tolerance);
}

template <int Dim>
LocalOutcome TaylorFit<Dim>::factorise(const LocalStencil<Dim>& stencil, Workspace& work) const {
  const int m = unknowns();
  if (stencil.centre < 0) return LocalOutcome::no_centre;
  if (stencil.size < needed_nodes()) return LocalOutcome::too_small;
  evaluate_weights(stencil, work.squared);
  work.basis.resize(static_cast<std::size_t>(m) * stencil.size);
  for (int j = 0; j < stencil.size; ++j) {
    basis_.evaluate(stencil.z.data() + static_cast<std::ptrdiff_t>(j) * Dim,
                    work.basis.data() + static_cast<std::ptrdiff_t>(j) * m);
  }
  work.by_qr = order() >= first_order_by_qr || !factorise_normal_equations(stencil, work);
  if (work.by_qr && !factorise_qr(stencil, work)) return LocalOutcome::singular;
  return LocalOutcome::ok;
}

template <int Dim>
void TaylorFit<Dim>::evaluate(const LocalStencil<Dim>& stencil, Workspace& work,
                              const Point<Dim>& offset, const Derivatives<Dim>& derivatives,
                              Eigen::Map<Eigen::MatrixXd> weights) const {
  const int m = unknowns();
  work.right_hand_side.resize(std::max(m, stencil.size));
  for (int d = 0; d < derivatives.size(); ++d) {
    std::vector<double>& v = work.right_hand_side;
    std::fill(v.begin(), v.end(), 0.0);
    basis_.differentiate(offset, derivatives[d], v.data());
    if (work.by_qr) {
      work.qr.solve_transposed_r({v.data(), v.data() + m});
      work.qr.apply_q({v.data(), v.data() + stencil.size});
    } else {
      work.normal_equations.solve({v.data(), v.data() + m});
    }
    double sum = 0;
    for (int j = 0; j < stencil.size; ++j) {
      double weight = 0;
      if (work.by_qr) {
        weight = std::sqrt(work.squared[j]) * v[j];
      } else {
        const double* basis = work.basis.data() + static_cast<std::ptrdiff_t>(j) * m;
        for (int a = 0; a < m; ++a) weight += basis[a] * v[a];
        weight *= work.squared[j];
      }
      weights(d, j) = weight;
      sum += j == stencil.centre ? 0 : weight;
    }
    weights(d, stencil.centre) = (order_of<Dim>(derivatives[d]) == 0 ? 1 : 0) - sum;
  }
}

template <int Dim>
void TaylorFit<Dim>::fill_batch(const StencilBatch<Dim>& batch, Workspace& work, Weights& weights,
                                std::span<LocalOutcome> outcomes) const {
  if (!TaylorBatch<Dim>::serves(order()) || batch.derivatives.size() == 0) return;
  work.batch.fill({basis_, *weight_, batch_limits}, batch, weights, outcomes);
}

template <int Dim>
void TaylorFit<Dim>::bound_conditions(const Sites<Dim>& sites, std::span<const int> anchors,
                                      const Stencils& stencils, int first, Scaling scaling,
                                      ConditionNorm norm, Workspace& work,
                                      std::span<ConditionBounds> bounds) const {
  std::fill(bounds.begin(), bounds.end(), ConditionBounds{});
  if (!TaylorBatch<Dim>::serves(order())) return;
  work.batch.judge({basis_, *weight_, batch_limits}, sites, anchors, stencils, first, scaling, norm,
                   bounds);
}

template <int Dim>
Eigen::MatrixXd TaylorFit<Dim>::local_matrix(const LocalStencil<Dim>& stencil,
                                             Scaling scaling) const {
  if (stencil.centre < 0 || stencil.size < needed_nodes()) return Eigen::MatrixXd::Zero(1, 1);
  std::vector<double> squared;
  evaluate_weights(stencil, squared);
  return basis_.moments(stencil, squared, scaling);
}

template <int Dim>
std::string TaylorFit<Dim>::unsupported(const Derivatives<Dim>& derivatives) const {
  for (const MultiIndex<Dim>& alpha : derivatives) {
    if (order_of<Dim>(alpha) > order()) {
      return fmt::format("a Taylor fit of order {} cannot give {}; ask for order={}", order(),
                         name_of<Dim>(alpha), order_of<Dim>(alpha));
    }
  }
  return {};
}

template <int Dim>
std::unique_ptr<Method<Dim>> make_taylor_method(std::string name, int order,
                                                std::shared_ptr<const WeightFunction> weight,
                                                StencilSurplus surplus,
                                                std::string default_stencil) {
  const Needs needs{.volumes = weight->uses_volumes(), .centre = true};
  TaylorFit<Dim> fit(order, std::move(weight));
  const int size = default_stencil_size<Dim>(fit.needed_nodes(), surplus, order);
  Promises promises;
  promises.reproduces = order;
  return std::make_unique<TaylorMethod<Dim>>(
      std::move(fit), typename TaylorMethod<Dim>::Traits{std::move(name), promises, needs, size,
                                                         std::move(default_stencil)});
}

template class TaylorFit<1>;
template class TaylorFit<2>;
template class TaylorFit<3>;
template std::unique_ptr<Method<1>> make_taylor_method<1>(std::string, int,
                                                          std::shared_ptr<const WeightFunction>,
                                                          StencilSurplus, std::string);
template std::unique_ptr<Method<2>> make_taylor_method<2>(std::string, int,
                                                          std::shared_ptr<const WeightFunction>,
                                                          StencilSurplus, std::string);
template std::unique_ptr<Method<3>> make_taylor_method<3>(std::string, int,
                                                          std::shared_ptr<const WeightFunction>,
                                                          StencilSurplus, std::string);

}  // namespace strongpoint
