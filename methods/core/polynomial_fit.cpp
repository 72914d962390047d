#include "methods/core/polynomial_fit.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace strongpoint {

template <int Dim>
PolynomialFit<Dim>::PolynomialFit(int degree, std::shared_ptr<const WeightFunction> weight)
    : basis_(0, degree), weight_(std::move(weight)) {
  if (weight_->uses_volumes()) return;
  const double at_anchor = 0;
  double squared = 0;
  weight_->squared({&at_anchor, 1}, {&squared, 1});
  if (!std::isfinite(squared)) least_distance_ = nearest;
}

template <int Dim>
void PolynomialFit<Dim>::evaluate_weights(const LocalStencil<Dim>& stencil,
                                          std::vector<double>& distances,
                                          std::vector<double>& squared) const {
  squared.resize(stencil.size);
  if (weight_->uses_volumes()) {
    std::copy(stencil.volumes.begin(), stencil.volumes.end(), squared.begin());
    return;
  }
  distances.resize(stencil.size);
  for (int j = 0; j < stencil.size; ++j) {
    distances[j] = std::max(stencil.rho[j], least_distance_);
  }
  weight_->squared(distances, squared);
}

template <int Dim>
LocalOutcome PolynomialFit<Dim>::factorise(const LocalStencil<Dim>& stencil,
                                           Workspace& work) const {
  evaluate_weights(stencil, work.distances, work.squared);
  return basis_.factorise(stencil, work.squared, work.qr);
}

template <int Dim>
void PolynomialFit<Dim>::evaluate(const LocalStencil<Dim>& stencil, Workspace& work,
                                  const Point<Dim>& offset, const Derivatives<Dim>& derivatives,
                                  Eigen::Map<Eigen::MatrixXd> weights) const {
  const int m = basis_.terms();
  work.vector.resize(stencil.size);
  for (int d = 0; d < derivatives.size(); ++d) {
    std::vector<double>& v = work.vector;
    basis_.differentiate(offset, derivatives[d], v.data());
    work.qr.solve_transposed_r({v.data(), v.data() + m});
    std::fill(v.begin() + m, v.end(), 0.0);
    work.qr.apply_q(v);
    for (int j = 0; j < stencil.size; ++j) weights(d, j) = std::sqrt(work.squared[j]) * v[j];
  }
}

template <int Dim>
void PolynomialFit<Dim>::fill_batch(const StencilBatch<Dim>& batch, Workspace& work,
                                    Weights& weights, std::span<LocalOutcome> outcomes) const {
  const bool is_function = !weight_->uses_volumes() && !weight_->is_one();
  work.product_offsets.assign(batch.derivatives.size() + 1, 0);
  work.batch.fill({.monomials = basis_.monomials(),
                   .known = batch.derivatives,
                   .products = {},
                   .product_offsets = work.product_offsets,
                   .uses_volumes = weight_->uses_volumes(),
                   .weight = is_function ? weight_.get() : nullptr,
                   .least_distance = least_distance_},
                  batch, weights, outcomes);
}

template <int Dim>
Eigen::MatrixXd PolynomialFit<Dim>::local_matrix(const LocalStencil<Dim>& stencil,
                                                 Scaling scaling) const {
  std::vector<double> distances;
  std::vector<double> squared;
  evaluate_weights(stencil, distances, squared);
  return basis_.moments(stencil, squared, scaling);
}

template <int Dim>
std::string PolynomialFit<Dim>::unsupported(const Derivatives<Dim>& derivatives) const {
  for (const MultiIndex<Dim>& alpha : derivatives) {
    if (order_of<Dim>(alpha) > degree()) {
      return fmt::format("a polynomial fit of degree {} cannot give {}; ask for degree {}",
                         degree(), name_of<Dim>(alpha), order_of<Dim>(alpha));
    }
  }
  return {};
}

template <int Dim>
std::unique_ptr<Method<Dim>> make_polynomial_method(std::string name, int degree,
                                                    std::shared_ptr<const WeightFunction> weight,
                                                    StencilSurplus surplus) {
  using Made = LocalMethod<Dim, PolynomialFit<Dim>>;
  const Promises promises{.reproduces = degree, .interpolates = false};
  const Needs needs{.volumes = weight->uses_volumes()};
  PolynomialFit<Dim> fit(degree, std::move(weight));
  const int size = default_stencil_size<Dim>(fit.needed_nodes(), surplus, degree);
  return std::make_unique<Made>(std::move(fit),
                                typename Made::Traits{std::move(name), promises, needs, size});
}

template class PolynomialFit<1>;
template class PolynomialFit<2>;
template class PolynomialFit<3>;
template std::unique_ptr<Method<1>> make_polynomial_method<1>(std::string, int,
                                                              std::shared_ptr<const WeightFunction>,
                                                              StencilSurplus);
template std::unique_ptr<Method<2>> make_polynomial_method<2>(std::string, int,
                                                              std::shared_ptr<const WeightFunction>,
                                                              StencilSurplus);
template std::unique_ptr<Method<3>> make_polynomial_method<3>(std::string, int,
                                                              std::shared_ptr<const WeightFunction>,
                                                              StencilSurplus);

}  // namespace strongpoint
