#include "methods/core/moving_fit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "methods/core/stencil_size.hpp"

namespace strongpoint {
namespace {

/// Windows are differentiated side by side up to this order.
constexpr int most_batched = 2;

/// True when beta <= alpha in every component.
template <int Dim>
bool is_within(const MultiIndex<Dim>& beta, const MultiIndex<Dim>& alpha) {
  for (int c = 0; c < Dim; ++c) {
    if (beta[c] > alpha[c]) return false;
  }
  return true;
}

template <int Dim>
MultiIndex<Dim> difference(const MultiIndex<Dim>& alpha, const MultiIndex<Dim>& beta) {
  MultiIndex<Dim> result = alpha;
  for (int c = 0; c < Dim; ++c) result[c] -= beta[c];
  return result;
}

}  // namespace

template <int Dim>
void MovingFit<Dim>::evaluate_windows(const LocalStencil<Dim>& stencil, const Point<Dim>& offset,
                                      std::vector<double>& squared) const {
  const double inverse = 1 / kernel_.length(stencil);
  squared.resize(stencil.size);
  for (int j = 0; j < stencil.size; ++j) {
    const Point<Dim> y = (offset - stencil.node(j)) * inverse;
    double value = 0;
    kernel_.kernel().evaluate(y.squaredNorm(), 0, &value);
    // Round-off makes a spline negative at the edge of its support.
    squared[j] =
        std::max(value, 0.0) * (measure_ == NodeMeasure::volume ? stencil.volumes[j] : 1.0);
  }
}

template <int Dim>
LocalOutcome MovingFit<Dim>::factorise_at(const LocalStencil<Dim>& stencil,
                                          const Point<Dim>& offset, Workspace& work) const {
  evaluate_windows(stencil, offset, work.squared);
  work.place.setConstant(std::numeric_limits<double>::quiet_NaN());  // equal to no other
  const LocalOutcome outcome = basis_.factorise(stencil, work.squared, work.qr);
  if (outcome != LocalOutcome::ok) return outcome;
  work.place = offset;
  const int m = basis_.terms();
  work.basis.resize(static_cast<std::size_t>(m) * stencil.size);
  for (int j = 0; j < stencil.size; ++j) {
    double* node = work.basis.data() + static_cast<std::ptrdiff_t>(j) * m;
    basis_.evaluate(stencil.z.data() + static_cast<std::ptrdiff_t>(j) * Dim, node);
    work.qr.solve_transposed_r({node, node + m});
  }
  return LocalOutcome::ok;
}

template <int Dim>
LocalOutcome MovingFit<Dim>::factorise(const LocalStencil<Dim>& stencil, Workspace& work) const {
  return factorise_at(stencil, Point<Dim>::Zero(), work);
}

template <int Dim>
void MovingFit<Dim>::prepare(const Derivatives<Dim>& derivatives, Workspace& work) const {
  if (work.prepared == derivatives && !work.steps.empty()) return;
  work.prepared = derivatives;
  work.known = {};
  work.steps.clear();
  const auto is_needed = [&](const MultiIndex<Dim>& beta) {
    if (order_of<Dim>(beta) == 0) return true;  // step 0 is the value, asked for or not
    if (differentiation_ == Differentiation::diffuse) return derivatives.contains(beta);
    return std::any_of(derivatives.begin(), derivatives.end(),
                       [&](const MultiIndex<Dim>& alpha) { return is_within<Dim>(beta, alpha); });
  };
  const int highest = derivatives.highest_order();
  for (const MultiIndex<Dim>& beta : Derivatives<Dim>::between_orders(0, highest)) {
    if (is_needed(beta)) work.known.merge({beta});
  }
  for (const MultiIndex<Dim>& alpha : work.known) {
    Step step{alpha, {}, RadialDerivative<Dim>(alpha)};
    for (int b = work.known.size() - 1; b >= 0; --b) {
      const MultiIndex<Dim>& beta = work.known[b];
      const bool is_fixed = differentiation_ == Differentiation::diffuse && order_of<Dim>(beta) > 0;
      if (is_fixed || !is_within<Dim>(beta, alpha)) continue;
      const MultiIndex<Dim> rest = difference<Dim>(alpha, beta);
      step.products.push_back(
          {b, work.known.index(rest),
           factorial<Dim>(alpha) / (factorial<Dim>(beta) * factorial<Dim>(rest))});
    }
    work.steps.push_back(std::move(step));
  }
  work.kernel.resize(highest + 1);
  list_products(work);
}

template <int Dim>
void MovingFit<Dim>::list_products(Workspace& work) const {
  const auto windows = Derivatives<Dim>::between_orders(0, most_batched);
  work.products.clear();
  work.product_offsets.assign(1, 0);
  for (const Step& step : work.steps) {
    for (const Product& product : step.products) {
      const MultiIndex<Dim>& window = work.known[product.window];
      if (product.window == 0 || !windows.contains(window)) continue;
      work.products.push_back({windows.index(window), product.function, product.binomial});
    }
    work.product_offsets.push_back(static_cast<int>(work.products.size()));
  }
}

template <int Dim>
void MovingFit<Dim>::differentiate_windows(const LocalStencil<Dim>& stencil,
                                           const Point<Dim>& offset, Workspace& work) const {
  const int n = stencil.size;
  work.windows.resize(static_cast<std::size_t>(n) * work.steps.size());
  std::copy(work.squared.begin(), work.squared.end(), work.windows.begin());
  if (differentiation_ == Differentiation::diffuse) return;
  const double inverse = 1 / kernel_.length(stencil);
  const int highest = static_cast<int>(work.kernel.size()) - 1;
  for (int j = 0; j < n; ++j) {
    const Point<Dim> y = (offset - stencil.node(j)) * inverse;
    kernel_.kernel().evaluate(y.squaredNorm(), highest, work.kernel.data());
    const double measure = measure_ == NodeMeasure::volume ? stencil.volumes[j] : 1.0;
    for (std::size_t k = 1; k < work.steps.size(); ++k) {
      const Step& step = work.steps[k];
      work.windows[k * n + j] = measure * std::pow(inverse, order_of<Dim>(step.alpha)) *
                                step.window(y, work.kernel.data());
    }
  }
}

template <int Dim>
void MovingFit<Dim>::differentiate_functions(const LocalStencil<Dim>& stencil,
                                             const Point<Dim>& offset, Workspace& work) const {
  const int n = stencil.size;
  const int m = basis_.terms();
  work.polynomial.resize(m);
  work.functions.resize(static_cast<std::size_t>(n) * work.steps.size());
  const Eigen::Map<const Eigen::MatrixXd> basis(work.basis.data(), m, n);
  Eigen::Map<Eigen::VectorXd> polynomial(work.polynomial.data(), m);
  for (std::size_t k = 0; k < work.steps.size(); ++k) {
    basis_.differentiate(offset, work.steps[k].alpha, work.polynomial.data());
    work.qr.solve_transposed_r(work.polynomial);
    for (const Product& product : work.steps[k].products) {
      if (product.window == 0) continue;  // the unknown itself
      const double* window = work.windows.data() + static_cast<std::ptrdiff_t>(product.window) * n;
      const double* function =
          work.functions.data() + static_cast<std::ptrdiff_t>(product.function) * n;
      for (int j = 0; j < n; ++j) {
        polynomial -= product.binomial * window[j] * function[j] * basis.col(j);
      }
    }
    for (int j = 0; j < n; ++j) work.functions[k * n + j] = basis.col(j).dot(polynomial);
  }
}

template <int Dim>
LocalOutcome MovingFit<Dim>::evaluate(const LocalStencil<Dim>& stencil, Workspace& work,
                                      const Point<Dim>& offset, const Derivatives<Dim>& derivatives,
                                      Eigen::Map<Eigen::MatrixXd> weights) const {
  const int n = stencil.size;
  prepare(derivatives, work);
  if (work.place != offset) {
    const LocalOutcome outcome = factorise_at(stencil, offset, work);
    if (outcome != LocalOutcome::ok) return outcome;
  }
  differentiate_windows(stencil, offset, work);
  differentiate_functions(stencil, offset, work);
  for (int d = 0; d < derivatives.size(); ++d) {
    weights.row(d).setZero();
    for (const Product& product : work.steps[work.known.index(derivatives[d])].products) {
      const double* window = work.windows.data() + static_cast<std::ptrdiff_t>(product.window) * n;
      const double* function =
          work.functions.data() + static_cast<std::ptrdiff_t>(product.function) * n;
      for (int j = 0; j < n; ++j) weights(d, j) += product.binomial * window[j] * function[j];
    }
  }
  return LocalOutcome::ok;
}

template <int Dim>
Eigen::MatrixXd MovingFit<Dim>::local_matrix(const LocalStencil<Dim>& stencil,
                                             Scaling scaling) const {
  std::vector<double> squared;
  evaluate_windows(stencil, Point<Dim>::Zero(), squared);
  return basis_.moments(stencil, squared, scaling);
}

template <int Dim>
void MovingFit<Dim>::fill_batch(const StencilBatch<Dim>& batch, Workspace& work, Weights& weights,
                                std::span<LocalOutcome> outcomes) const {
  const bool is_full = differentiation_ == Differentiation::full;
  if (is_full && batch.derivatives.highest_order() > most_batched) return;
  prepare(batch.derivatives, work);
  work.batch.fill({.monomials = basis_.monomials(),
                   .known = work.known,
                   .products = work.products,
                   .product_offsets = work.product_offsets,
                   .profile = &profile_,
                   .uses_volumes = measure_ == NodeMeasure::volume},
                  batch, weights, outcomes);
}

template <int Dim>
std::string MovingFit<Dim>::unsupported(const Derivatives<Dim>& derivatives) const {
  const bool is_diffuse = differentiation_ == Differentiation::diffuse;
  for (const MultiIndex<Dim>& alpha : derivatives) {
    if (is_diffuse && order_of<Dim>(alpha) > basis_.degree()) {
      return fmt::format("a fit of degree {} has no diffuse {}; ask for degree={}", basis_.degree(),
                         name_of<Dim>(alpha), order_of<Dim>(alpha));
    }
    if (!is_diffuse && order_of<Dim>(alpha) > kernel_.kernel().smoothness()) {
      return fmt::format(
          "{} of a shape function needs a kernel with {} continuous derivatives, this "
          "one has {}",
          name_of<Dim>(alpha), order_of<Dim>(alpha), kernel_.kernel().smoothness());
    }
  }
  return {};
}

template <int Dim>
std::unique_ptr<Method<Dim>> make_moving_method(std::string name, MovingFit<Dim> fit) {
  using Made = LocalMethod<Dim, MovingFit<Dim>>;
  const Promises promises{.reproduces = fit.degree(), .interpolates = false};
  const Needs needs{.volumes = fit.measure() == NodeMeasure::volume, .spacing = true};
  const int size = std::max(2 * fit.needed_nodes(), boundary_lattice_size<Dim>(fit.degree()));
  const std::string rule = fit.kernel().default_stencil();
  return std::make_unique<Made>(
      std::move(fit), typename Made::Traits{std::move(name), promises, needs, size, rule});
}

template class MovingFit<1>;
template class MovingFit<2>;
template class MovingFit<3>;
template std::unique_ptr<Method<1>> make_moving_method<1>(std::string, MovingFit<1>);
template std::unique_ptr<Method<2>> make_moving_method<2>(std::string, MovingFit<2>);
template std::unique_ptr<Method<3>> make_moving_method<3>(std::string, MovingFit<3>);

}  // namespace strongpoint
