#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "methods/core/end_splines.hpp"
#include "methods/core/max_entropy.hpp"

namespace strongpoint {
namespace {

/// A point this far out of the nodes, in spacings, lies outside.
constexpr double outside_tolerance = 1e-9;
/// Below this the max-ent functions' share is that at the very end.
constexpr double no_share = 1e-14;

/// One end of a 1D stencil that is an end of the cloud; lengths in spacings, counted inwards.
struct End {
  double position = 0;  ///< of the node at the end, relative to the anchor
  double inwards = 1;   ///< +1 at the left end, -1 at the right one
  double second = 0;    ///< distances of the next two nodes
  double third = 0;
  bool is_real = false;  ///< the stencil would reach further if there were nodes
};

End end_of(const std::vector<double>& ascending, double widest, double spacing, bool is_left) {
  const std::size_t n = ascending.size();
  const auto at = [&](std::size_t i) { return ascending[is_left ? i : n - 1 - i] / spacing; };
  End end{.position = at(0), .inwards = is_left ? 1.0 : -1.0};
  end.second = std::abs(at(1) - at(0));
  end.third = std::abs(at(2) - at(0));
  end.is_real = std::abs(at(0)) + widest <= (1 + outside_tolerance) / spacing;
  return end;
}

/// The max-ent part of a blend and how its share and mean move along the axis.
struct Share {
  double mass, d_mass, dd_mass;      // 1 - N_1 - N_2
  double mean, d_moment, dd_moment;  // the moment is mass times mean, h - N_2 x_2
};

Share share_of(const EndSplines& splines, double xi, double second) {
  Share share{};
  share.mass = std::max(0.0, 1 - splines.first[0] - splines.second[0]);
  share.d_mass = -splines.first[1] - splines.second[1];
  share.dd_mass = -splines.first[2] - splines.second[2];
  const bool is_end = share.mass < no_share;
  share.mean = is_end ? splines.rest_at_end : (xi - second * splines.second[0]) / share.mass;
  if (is_end) share.mass = 0;
  share.d_moment = 1 - second * splines.second[1];
  share.dd_moment = -second * splines.second[2];
  return share;
}

/// One derivative of mass times q(mean), q having the statistics of a max-ent fit.
template <int S>
void add_share(const EntropyFit<S>& fit, const Share& share, int order, std::vector<double>& row) {
  using Vector = Eigen::Matrix<double, S, 1>;
  Vector along = Vector::Zero();  // how the wanted means move with the mean position
  Vector twice = Vector::Zero();
  along[0] = 1;
  if constexpr (S == 2) twice[1] = 2;
  row.assign(fit.size(), 0.0);
  const double direct = order == 0 ? share.mass : order == 1 ? share.d_mass : share.dd_mass;
  for (int a = 0; a < fit.size(); ++a) row[a] = direct * fit.distribution()[a];
  const double drift = share.d_moment - share.mean * share.d_mass;  // mass times mean'
  if (order == 1) fit.add_first(drift, along, row);
  if (order == 2) {
    fit.add_first(share.dd_moment - share.mean * share.dd_mass, along, row);
    if (share.mass > 0) fit.add_second(drift * drift / share.mass, along, along, twice, row);
  }
}

/// Fills in the statistics about a mean position and solves; the two end nodes have no say.
template <int S>
EntropyOutcome solve_inside(const LocalStencil<1>& stencil, EntropyFit<S>& fit, const End& end,
                            double mean, double beta, double variance) {
  fit.resize(stencil.size);
  for (int a = 0; a < stencil.size; ++a) {
    const double xi = end.inwards * (stencil.z[a] / stencil.spacing - end.position);
    fit.statistics(a)[0] = xi - mean;
    if constexpr (S == 2) fit.statistics(a)[1] = (xi - mean) * (xi - mean) - variance;
    const bool is_inside = xi > (end.second + end.third) / 2;
    fit.log_prior(a) = !is_inside ? -std::numeric_limits<double>::infinity()
                       : S == 1   ? -beta * (xi - mean) * (xi - mean)
                                  : 0;
  }
  return fit.solve();
}

/// Writes the B-splines and the max-ent functions of a point at xi.
template <int S>
void write_blend(const LocalStencil<1>& stencil, const EntropyFit<S>& fit, const End& end,
                 const EndSplines& splines, const Share& share, const Derivatives<1>& derivatives,
                 std::vector<double>& row, Eigen::Map<Eigen::MatrixXd> weights) {
  for (int d = 0; d < derivatives.size(); ++d) {
    const int order = derivatives[d][0];
    add_share<S>(fit, share, order, row);
    const double scale = std::pow(end.inwards / stencil.spacing, order);
    for (int a = 0; a < stencil.size; ++a) {
      const double xi = end.inwards * (stencil.z[a] / stencil.spacing - end.position);
      double weight = row[a];
      if (xi < end.second / 2) weight += splines.first[order];
      if (xi > end.second / 2 && xi < (end.second + end.third) / 2) weight += splines.second[order];
      weights(d, a) = scale * weight;
    }
  }
}

}  // namespace

template <int Dim>
LocalOutcome MaxEntropy<Dim>::evaluate_blend(const LocalStencil<Dim>& stencil, Workspace& work,
                                             const Point<Dim>& at,
                                             const Derivatives<Dim>& derivatives,
                                             Eigen::Map<Eigen::MatrixXd> weights) const {
  if constexpr (Dim == 1) {
    std::array<End, 2> ends = {end_of(work.positions, work.widest, stencil.spacing, true),
                               end_of(work.positions, work.widest, stencil.spacing, false)};
    const auto from = [&](const End& e) {
      return e.inwards * (at[0] / stencil.spacing - e.position);
    };
    const auto width_of = [&](const End& e) {
      return end_spline_width(e.second, e.third, work.widest);
    };
    if (from(ends[1]) < from(ends[0])) std::swap(ends[0], ends[1]);
    const End& end = ends[0];
    if (!end.is_real) return evaluate_order_1_or_2(stencil, work, at, derivatives, weights);
    const double xi = from(end);
    const double width = width_of(end);
    const bool is_crowded = ends[1].is_real && xi < width && from(ends[1]) < width_of(ends[1]);
    if (is_crowded || xi < -outside_tolerance) return LocalOutcome::infeasible;
    const EndSplines splines(std::max(0.0, xi), end.second, width);
    const Share share = share_of(splines, std::max(0.0, xi), end.second);
    const double variance = options_.gap * work.widest * work.widest;
    EntropyOutcome solved{};
    if (options_.order == 1) {
      solved = solve_inside<1>(stencil, work.linear, end, share.mean, options_.beta, variance);
    } else {
      solved = solve_inside<2>(stencil, work.quadratic, end, share.mean, options_.beta, variance);
    }
    if (solved != EntropyOutcome::inside) return LocalOutcome::infeasible;
    if (options_.order == 1) {
      write_blend<1>(stencil, work.linear, end, splines, share, derivatives, work.row, weights);
    } else {
      write_blend<2>(stencil, work.quadratic, end, splines, share, derivatives, work.row, weights);
    }
    return LocalOutcome::ok;
  } else {
    return evaluate_order_1_or_2(stencil, work, at, derivatives, weights);
  }
}

template LocalOutcome MaxEntropy<1>::evaluate_blend(const LocalStencil<1>&, Workspace&,
                                                    const Point<1>&, const Derivatives<1>&,
                                                    Eigen::Map<Eigen::MatrixXd>) const;
template LocalOutcome MaxEntropy<2>::evaluate_blend(const LocalStencil<2>&, Workspace&,
                                                    const Point<2>&, const Derivatives<2>&,
                                                    Eigen::Map<Eigen::MatrixXd>) const;
template LocalOutcome MaxEntropy<3>::evaluate_blend(const LocalStencil<3>&, Workspace&,
                                                    const Point<3>&, const Derivatives<3>&,
                                                    Eigen::Map<Eigen::MatrixXd>) const;

}  // namespace strongpoint
