#include "methods/core/max_entropy.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace strongpoint {
namespace {

/// Relative extent below which nodes lie on a line or plane: it makes the determinant small.
constexpr double flat_tolerance = 1e-6;
/// A point this near to the end of a 1D stencil, in spacings, lies on it.
constexpr double end_tolerance = 1e-9;
/// Gaps tried in 2D relative to the one wanted, and multiples of `inset` tried at the boundary.
constexpr std::array<double, 4> gap_factors = {1, 1.5, 0.7, 2.2};
constexpr std::array<double, 4> inset_factors = {4, 3, 5, 2};
/// A distribution of order 2 is taken at once when its strain is below this multiple of the Gauss
/// bell's, 2/g + 2/g^2 in 2D; otherwise the least strained of all that are tried.
constexpr double relaxed = 2;

/// Writes the derivatives (the value left out) of a distribution whose means move by `rates`; with
/// a shift, first derivatives are carried back by it along the second ones. Lengths are in units of
/// `unit`.
template <int Dim, int S>
void write_derivatives(const EntropyFit<S>& fit, const MeanRates<Dim, S>& rates,
                       const Point<Dim>& shift, double unit, const Derivatives<Dim>& derivatives,
                       std::vector<double>& row, Eigen::Map<Eigen::MatrixXd> weights) {
  for (int d = 0; d < derivatives.size(); ++d) {
    const int order = order_of<Dim>(derivatives[d]);
    if (order == 0) continue;
    std::array<int, 2> axes{};
    int found = 0;
    for (int c = 0; c < Dim; ++c) {
      for (int k = 0; k < derivatives[d][c]; ++k) axes[found++] = c;
    }
    const auto [i, j] = axes;
    row.assign(fit.size(), 0.0);
    if (order == 1) {
      fit.add_first(1, rates.first.col(i), row);
      for (int c = 0; c < Dim; ++c) {
        if (shift[c] == 0) continue;
        fit.add_second(-shift[c], rates.first.col(i), rates.first.col(c),
                       rates.second.col(i * Dim + c), row);
      }
    } else {
      fit.add_second(1, rates.first.col(i), rates.first.col(j), rates.second.col(i * Dim + j), row);
    }
    const double scale = order == 1 ? 1 / unit : 1 / (unit * unit);
    for (int a = 0; a < fit.size(); ++a) weights(d, a) = scale * row[a];
  }
}

/// Writes the value if it is asked for.
template <int Dim>
void write_value(std::span<const double> value, const Derivatives<Dim>& derivatives,
                 Eigen::Map<Eigen::MatrixXd> weights) {
  const Eigen::Map<const Eigen::RowVectorXd> row(value.data(), weights.cols());
  for (int d = 0; d < derivatives.size(); ++d) {
    if (order_of<Dim>(derivatives[d]) == 0) weights.row(d) = row;
  }
}

}  // namespace

template <int Dim>
LocalOutcome MaxEntropy<Dim>::factorise(const LocalStencil<Dim>& stencil, Workspace& work) const {
  if (stencil.size < needed_nodes()) return LocalOutcome::too_small;
  Point<Dim> mean = Point<Dim>::Zero();
  for (int a = 0; a < stencil.size; ++a) mean += stencil.node(a) / stencil.size;
  Eigen::Matrix<double, Dim, Dim> extent = Eigen::Matrix<double, Dim, Dim>::Zero();
  for (int a = 0; a < stencil.size; ++a) {
    const Point<Dim> deviation = stencil.node(a) - mean;
    extent += deviation * deviation.transpose();
  }
  const double isotropic = std::pow(extent.trace() / Dim, Dim);
  if (!(extent.determinant() > flat_tolerance * flat_tolerance * isotropic)) {
    return LocalOutcome::singular;
  }
  if constexpr (Dim == 1) {
    work.positions.assign(stencil.z.begin(), stencil.z.end());
    std::sort(work.positions.begin(), work.positions.end());
    work.widest = 0;
    for (int a = 1; a < stencil.size; ++a) {
      work.widest = std::max(work.widest, work.positions[a] - work.positions[a - 1]);
    }
    work.widest /= stencil.spacing;
    const double* x = work.positions.data();
    const double* last = x + stencil.size - 1;
    work.left_ramp = std::min(work.widest / 2, (x[1] - x[0]) / stencil.spacing);
    work.right_ramp = std::min(work.widest / 2, (last[0] - last[-1]) / stencil.spacing);
  }
  return LocalOutcome::ok;
}

template <int Dim>
EntropyOutcome MaxEntropy<Dim>::solve_linear(const LocalStencil<Dim>& stencil, Workspace& work,
                                             const Point<Dim>& at) const {
  work.linear.resize(stencil.size);
  for (int a = 0; a < stencil.size; ++a) {
    work.linear.statistics(a) = (stencil.node(a) - at) / stencil.spacing;
    work.linear.log_prior(a) = -options_.locality() * work.linear.statistics(a).squaredNorm();
  }
  return work.linear.solve();
}

template <int Dim>
Point<Dim> MaxEntropy<Dim>::prior_mean(const LocalStencil<Dim>& stencil,
                                       const Point<Dim>& at) const {
  double total = 0;
  Point<Dim> sum = Point<Dim>::Zero();
  const double nearest = (stencil.node(0) - at).squaredNorm() / (stencil.spacing * stencil.spacing);
  for (int a = 0; a < stencil.size; ++a) {
    const Point<Dim> y = (stencil.node(a) - at) / stencil.spacing;
    const double weight = std::exp(-options_.locality() * (y.squaredNorm() - nearest));
    sum += weight * y;
    total += weight;
  }
  return at + stencil.spacing / total * sum;
}

template <int Dim>
LocalOutcome MaxEntropy<Dim>::evaluate_order_1(const LocalStencil<Dim>& stencil, Workspace& work,
                                               const Point<Dim>& at,
                                               const Derivatives<Dim>& derivatives,
                                               Eigen::Map<Eigen::MatrixXd> weights) const {
  const EntropyOutcome outcome = solve_linear(stencil, work, at);
  if (outcome == EntropyOutcome::outside) return LocalOutcome::infeasible;
  write_value<Dim>(work.linear.distribution(), derivatives, weights);
  if (derivatives.highest_order() == 0) return LocalOutcome::ok;
  if (outcome == EntropyOutcome::on_face) {
    const Point<Dim> inside = at + options_.inset * (prior_mean(stencil, at) - at);
    if (solve_linear(stencil, work, inside) != EntropyOutcome::inside) {
      return LocalOutcome::infeasible;
    }
  }
  MeanRates<Dim, Dim> rates;
  rates.first.setIdentity();
  write_derivatives<Dim, Dim>(work.linear, rates, Point<Dim>::Zero(), stencil.spacing, derivatives,
                              work.row, weights);
  return LocalOutcome::ok;
}

template <int Dim>
double MaxEntropy<Dim>::solve_quadratic(const LocalStencil<Dim>& stencil, Workspace& work,
                                        const Point<Dim>& at, double factor,
                                        MeanRates<Dim, moments>& rates) const {
  using Moments = Eigen::Matrix<double, moments, 1>;
  Moments means = Moments::Zero();
  rates = {};
  rates.first.template topLeftCorner<Dim, Dim>().setIdentity();
  const double gap = factor * options_.gap;
  if constexpr (Dim == 1) {
    const double h = work.widest;
    const double from_left = (at[0] - work.positions.front()) / stencil.spacing;
    const double from_right = (work.positions.back() - at[0]) / stencil.spacing;
    const double ramp = from_left < from_right ? work.left_ramp : work.right_ramp;
    const double left = 1 - std::min(from_left, from_right) / ramp;  // of the ramp
    const bool on_ramp = left > end_tolerance;
    means[1] = gap * h * h * (on_ramp ? 1 - left * left : 1);
    const double slope = on_ramp ? 2 * gap * h * h * left / ramp : 0;
    rates.first(1, 0) = from_left < from_right ? slope : -slope;
    rates.second(1, 0) = 2 - (on_ramp ? 2 * gap * h * h / (ramp * ramp) : 0);
  }
  if constexpr (Dim == 2) {
    means << 0, 0, gap, 0, gap;
    rates.second(2, 0) = 2;
    rates.second(3, 1) = rates.second(3, 2) = 1;
    rates.second(4, 3) = 2;
  }
  work.quadratic.resize(stencil.size);
  for (int a = 0; a < stencil.size; ++a) {
    const Point<Dim> y = (stencil.node(a) - at) / stencil.spacing;
    if constexpr (Dim == 1) work.quadratic.statistics(a) << y[0], y[0] * y[0];
    if constexpr (Dim == 2) {
      work.quadratic.statistics(a) << y[0], y[1], y[0] * y[0], y[0] * y[1], y[1] * y[1];
    }
    work.quadratic.statistics(a) -= means;
    work.quadratic.log_prior(a) = 0;
  }
  if (work.quadratic.solve() == EntropyOutcome::inside) return work.quadratic.strain();
  return std::numeric_limits<double>::infinity();
}

template <int Dim>
bool MaxEntropy<Dim>::solve_relaxed(const LocalStencil<Dim>& stencil, Workspace& work,
                                    const Point<Dim>& at, std::span<const Point<Dim>> shifts,
                                    Point<Dim>& shift, MeanRates<Dim, moments>& rates) const {
  const double bell = 2 / options_.gap + 2 / (options_.gap * options_.gap);
  const std::size_t gaps = Dim == 1 ? 1 : gap_factors.size();  // any gap will do in 1D
  double best = std::numeric_limits<double>::infinity();
  double factor = 1;
  for (const Point<Dim>& candidate : shifts) {
    for (std::size_t g = 0; g < gaps; ++g) {
      const double strain =
          solve_quadratic(stencil, work, at + stencil.spacing * candidate, gap_factors[g], rates);
      if (!(strain < best)) continue;
      best = strain;
      factor = gap_factors[g];
      shift = candidate;
      if (strain < relaxed * bell) return true;
    }
  }
  return best < std::numeric_limits<double>::infinity() &&
         solve_quadratic(stencil, work, at + stencil.spacing * shift, factor, rates) == best;
}

template <int Dim>
LocalOutcome MaxEntropy<Dim>::evaluate_order_2(const LocalStencil<Dim>& stencil, Workspace& work,
                                               const Point<Dim>& at,
                                               const Derivatives<Dim>& derivatives,
                                               Eigen::Map<Eigen::MatrixXd> weights) const {
  const EntropyOutcome outcome = solve_linear(stencil, work, at);
  if (outcome == EntropyOutcome::outside) return LocalOutcome::infeasible;
  MeanRates<Dim, moments> rates;
  Point<Dim> shift = Point<Dim>::Zero();  // in spacings
  const std::array<Point<Dim>, 1> unmoved = {shift};
  bool is_found =
      outcome == EntropyOutcome::inside && solve_relaxed(stencil, work, at, unmoved, shift, rates);
  write_value<Dim>(is_found ? work.quadratic.distribution() : work.linear.distribution(),
                   derivatives, weights);
  if (derivatives.highest_order() == 0) return LocalOutcome::ok;
  if (!is_found) {
    const Point<Dim> inwards = (prior_mean(stencil, at) - at) / stencil.spacing;
    std::array<Point<Dim>, inset_factors.size()> shifts;
    for (std::size_t i = 0; i < shifts.size(); ++i) {
      shifts[i] = inset_factors[i] * options_.inset * inwards;
      if constexpr (Dim == 1) {  // where the ramp ends
        shifts[i][0] = inwards[0] > 0 ? work.left_ramp : -work.right_ramp;
      }
    }
    is_found = solve_relaxed(stencil, work, at, shifts, shift, rates);
    if (!is_found) return LocalOutcome::infeasible;
  }
  write_derivatives<Dim, moments>(work.quadratic, rates, shift, stencil.spacing, derivatives,
                                  work.row, weights);
  return LocalOutcome::ok;
}

template <int Dim>
LocalOutcome MaxEntropy<Dim>::evaluate(const LocalStencil<Dim>& stencil, Workspace& work,
                                       const Point<Dim>& offset,
                                       const Derivatives<Dim>& derivatives,
                                       Eigen::Map<Eigen::MatrixXd> weights) const {
  if (options_.boundary == MaxEntropyBoundary::bspline) {
    return evaluate_blend(stencil, work, offset, derivatives, weights);
  }
  return evaluate_order_1_or_2(stencil, work, offset, derivatives, weights);
}

template <int Dim>
LocalOutcome MaxEntropy<Dim>::evaluate_order_1_or_2(const LocalStencil<Dim>& stencil,
                                                    Workspace& work, const Point<Dim>& at,
                                                    const Derivatives<Dim>& derivatives,
                                                    Eigen::Map<Eigen::MatrixXd> weights) const {
  return options_.order == 1 ? evaluate_order_1(stencil, work, at, derivatives, weights)
                             : evaluate_order_2(stencil, work, at, derivatives, weights);
}

template <int Dim>
Eigen::MatrixXd MaxEntropy<Dim>::local_matrix(const LocalStencil<Dim>& stencil,
                                              Scaling scaling) const {
  const Point<Dim> mean = prior_mean(stencil, Point<Dim>::Zero());
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(Dim, Dim);
  double total = 0;
  for (int a = 0; a < stencil.size; ++a) {
    const double weight =
        std::exp(-options_.locality() * std::pow(stencil.rho[a] / stencil.spacing, 2));
    const Point<Dim> deviation = stencil.node(a) - mean;
    covariance += weight * deviation * deviation.transpose();
    total += weight;
  }
  return covariance * (scaling == Scaling::row ? stencil.radius : 1.0) / total;
}

template <int Dim>
std::string MaxEntropy<Dim>::unsupported(const Derivatives<Dim>& derivatives) const {
  if (options_.order == 2 && Dim == 3) {
    return "max_ent[order=2] is not offered in 3D, where no gap is known that scattered nodes can "
           "attain";
  }
  if (options_.boundary == MaxEntropyBoundary::bspline && Dim > 1) {
    return "max_ent[boundary=bspline] exists in 1D only: in more dimensions it needs a spline "
           "description of the boundary, which a cloud does not have";
  }
  for (const MultiIndex<Dim>& alpha : derivatives) {
    if (order_of<Dim>(alpha) > 2) {
      return fmt::format("max_ent gives derivatives up to the second, not {}", name_of<Dim>(alpha));
    }
  }
  return {};
}

template class MaxEntropy<1>;
template class MaxEntropy<2>;
template class MaxEntropy<3>;

}  // namespace strongpoint
