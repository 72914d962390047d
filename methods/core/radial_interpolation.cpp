#include "methods/core/radial_interpolation.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "methods/core/error.hpp"
#include "methods/core/monomial.hpp"
#include "methods/core/monomial_basis.hpp"

namespace strongpoint {
namespace {

/// Smallest pivot over the largest entry that is more than round-off.
constexpr double pivot_tolerance = 1e-15;
/// The shape parameter over the local spacing when nothing is said. A choice, the same for all
/// functions: larger ones err less and are worse conditioned.
constexpr const char* default_factor = "2";

}  // namespace

RadialShape::RadialShape(const Options& options) {
  if (!options.has("shape_length")) {
    factor_ = options.number("shape", 0.01, 1000);
    return;
  }
  length_ = options.number("shape_length", 1e-9, 1e9);
  if (options.text("shape") != default_factor) {
    throw UsageError(fmt::format("{} and shape_length exclude each other; give one of them",
                                 options.where("shape")));
  }
}

std::vector<OptionDoc> RadialShape::options() {
  return {{"shape", default_factor, "shape parameter c over the local spacing, 0.01 to 1000"},
          {"shape_length", "", "instead: a fixed c in the unit of the problem, 1e-9 to 1e9"}};
}

std::vector<OptionDoc> radial_options(const std::string& default_kernel) {
  std::vector<OptionDoc> options = RadialFunction::options(default_kernel);
  for (OptionDoc& option : RadialShape::options()) options.push_back(std::move(option));
  return options;
}

template <int Dim>
RadialInterpolation<Dim>::RadialInterpolation(const Options& options, int degree)
    : degree_(degree),
      function_(options),
      shape_(options),
      monomials_(Derivatives<Dim>::between_orders(0, std::max(0, degree))) {
  if (function_.has_shape() || (!shape_.is_fixed() && options.text("shape") == default_factor)) {
    return;
  }
  throw UsageError(fmt::format("{}={} has no shape parameter; leave shape and shape_length out",
                               options.where("kernel"), options.text("kernel")));
}

template <int Dim>
void RadialInterpolation<Dim>::fill_matrix(const LocalStencil<Dim>& stencil, double* matrix) const {
  const int n = stencil.size;
  const int all = n + terms();
  const double shape = shape_.over_radius(stencil);
  const auto entry = [&](int i, int j) -> double& {
    return matrix[static_cast<std::ptrdiff_t>(i) * all + j];
  };
  std::fill(matrix, matrix + static_cast<std::ptrdiff_t>(all) * all, 0.0);
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j <= i; ++j) {
      function_.evaluate((stencil.node(i) - stencil.node(j)).squaredNorm(), shape, 0, &entry(i, j));
      entry(j, i) = entry(i, j);
    }
    for (int a = 0; a < terms(); ++a) {
      const double value =
          monomial_derivative<Dim>(monomials_[a], MultiIndex<Dim>{}, stencil.node(i));
      entry(i, n + a) = value;
      entry(n + a, i) = value;
    }
  }
}

template <int Dim>
LocalOutcome RadialInterpolation<Dim>::factorise(const LocalStencil<Dim>& stencil,
                                                 Workspace& work) const {
  const int n = stencil.size;
  const int m = terms();
  if (n < needed_nodes()) return LocalOutcome::too_small;
  if (m > 0 && !factorise_polynomials<Dim>(stencil, monomials_, work.polynomials)) {
    return LocalOutcome::singular;
  }
  fill_matrix(stencil, work.bordered.prepare(n + m));
  return work.bordered.factorise(pivot_tolerance) ? LocalOutcome::ok
         : function_.has_shape()                  ? LocalOutcome::flat
                                                  : LocalOutcome::singular;
}

template <int Dim>
void RadialInterpolation<Dim>::prepare(const LocalStencil<Dim>& stencil, Workspace& work,
                                       const Point<Dim>& offset,
                                       const Derivatives<Dim>& derivatives) const {
  if (!(work.prepared == derivatives)) {
    work.prepared = derivatives;
    work.radials.clear();
    for (const MultiIndex<Dim>& alpha : derivatives) work.radials.emplace_back(alpha);
  }
  const double shape = shape_.over_radius(stencil);
  const int order = derivatives.highest_order();
  work.functions.resize(static_cast<std::size_t>(stencil.size) * (order + 1));
  for (int j = 0; j < stencil.size; ++j) {
    function_.evaluate((offset - stencil.node(j)).squaredNorm(), shape, order,
                       work.functions.data() + static_cast<std::ptrdiff_t>(j) * (order + 1));
  }
}

template <int Dim>
void RadialInterpolation<Dim>::fill_right_hand_side(const LocalStencil<Dim>& stencil,
                                                    const Workspace& work, const Point<Dim>& offset,
                                                    int d, double* result) const {
  const int stride = work.prepared.highest_order() + 1;
  for (int j = 0; j < stencil.size; ++j) {
    result[j] = work.radials[d](offset - stencil.node(j),
                                work.functions.data() + static_cast<std::ptrdiff_t>(j) * stride);
  }
  for (int a = 0; a < terms(); ++a) {
    result[stencil.size + a] = monomial_derivative<Dim>(monomials_[a], work.prepared[d], offset);
  }
}

template <int Dim>
void RadialInterpolation<Dim>::evaluate(const LocalStencil<Dim>& stencil, Workspace& work,
                                        const Point<Dim>& offset,
                                        const Derivatives<Dim>& derivatives,
                                        Eigen::Map<Eigen::MatrixXd> weights) const {
  prepare(stencil, work, offset, derivatives);
  work.right_hand_side.resize(stencil.size + terms());
  for (int d = 0; d < derivatives.size(); ++d) {
    fill_right_hand_side(stencil, work, offset, d, work.right_hand_side.data());
    work.bordered.solve(work.right_hand_side);
    for (int j = 0; j < stencil.size; ++j) weights(d, j) = work.right_hand_side[j];
  }
}

template <int Dim>
Eigen::MatrixXd RadialInterpolation<Dim>::local_matrix(const LocalStencil<Dim>& stencil,
                                                       Scaling scaling) const {
  const int n = stencil.size;
  if (n < needed_nodes()) return Eigen::MatrixXd::Zero(1, 1);
  Eigen::MatrixXd matrix(n + terms(), n + terms());
  fill_matrix(stencil, matrix.data());
  for (int a = 0; a < terms() && scaling == Scaling::row; ++a) {
    matrix.col(n + a) *= std::pow(stencil.radius, order_of<Dim>(monomials_[a]));
  }
  return matrix;
}

template <int Dim>
std::string RadialInterpolation<Dim>::unsupported(const Derivatives<Dim>& derivatives) const {
  for (const MultiIndex<Dim>& alpha : derivatives) {
    std::string why = function_.unsupported(order_of<Dim>(alpha), name_of<Dim>(alpha));
    if (!why.empty()) return why;
  }
  return {};
}

template <int Dim>
std::unique_ptr<Method<Dim>> make_radial_method(std::string name, const Options& options,
                                                int degree) {
  using Made = LocalMethod<Dim, RadialInterpolation<Dim>>;
  RadialInterpolation<Dim> kernel(options, degree);
  Promises promises;
  promises.reproduces = degree;
  promises.scale_covariant = !kernel.shape().is_fixed();
  const Needs needs{.spacing = kernel.uses_spacing()};
  const int size = Dim == 1 ? 5 : Dim == 2 ? 15 : 30;
  return std::make_unique<Made>(std::move(kernel),
                                typename Made::Traits{std::move(name), promises, needs, size});
}

template class RadialInterpolation<1>;
template class RadialInterpolation<2>;
template class RadialInterpolation<3>;
template std::unique_ptr<Method<1>> make_radial_method<1>(std::string, const Options&, int);
template std::unique_ptr<Method<2>> make_radial_method<2>(std::string, const Options&, int);
template std::unique_ptr<Method<3>> make_radial_method<3>(std::string, const Options&, int);

}  // namespace strongpoint
