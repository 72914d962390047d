#include "methods/core/global_interpolation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include <Eigen/Dense>
#include <fmt/format.h>

#include "methods/core/condition.hpp"
#include "methods/core/error.hpp"
#include "methods/core/parallel_errors.hpp"
#include "methods/core/rule.hpp"
#include "methods/core/spans.hpp"

namespace strongpoint {
namespace {

using Factor = Eigen::PartialPivLU<Eigen::MatrixXd>;

/// Error of smooth nodal values given back that is still taken for round-off. Measured on Poisson's
/// equation with multiquadrics: solutions gain digits up to 1e-7 and lose all of them at 1e-2. That
/// the weights of the value at a node are one there and zero elsewhere fails much earlier and harms
/// no smooth solution.
constexpr double smooth_tolerance = 1e-4;
/// Nodes whose value weights are looked at.
constexpr int sampled_nodes = 32;
/// Right-hand sides solved together, which is what makes the solves fast.
constexpr int block = 32;

/// Runs work on one thread of a team: Eigen then does not split it, which would make the bits
/// depend on the number of threads.
template <class Work>
void unsplit(Work&& work) {
  ParallelErrors errors;
#pragma omp parallel
#pragma omp single
  errors.guard(0, std::forward<Work>(work));
  errors.rethrow();
}

/// Largest error at some nodes of the values that the interpolation gives back there, of smooth
/// nodal values of size one.
template <int Dim>
double smooth_error(const Factor& factor, const Eigen::MatrixXd& matrix,
                    const LocalStencil<Dim>& stencil) {
  Eigen::VectorXd values = Eigen::VectorXd::Zero(matrix.rows());
  for (int j = 0; j < stencil.size; ++j) {
    double phase = 0.5;
    for (int c = 0; c < Dim; ++c) phase += (c + 1) * stencil.node(j)[c];
    values[j] = std::cos(phase);
  }
  const int count = std::min(stencil.size, sampled_nodes);
  Eigen::MatrixXd right(matrix.rows(), count);
  std::vector<int> nodes(count);
  for (int s = 0; s < count; ++s) {
    nodes[s] = static_cast<int>(static_cast<std::int64_t>(s) * stencil.size / count);
    right.col(s) = matrix.col(nodes[s]);
  }
  const Eigen::VectorXd given_back = factor.solve(right).transpose() * values;
  const double error = (given_back - values(nodes)).cwiseAbs().maxCoeff();
  return given_back.allFinite() ? error : std::numeric_limits<double>::infinity();
}

/// All nodes by distance from the first anchor, then by coordinates: however they are numbered, the
/// matrix is the same.
template <int Dim>
std::vector<int> sorted_nodes(const Sites<Dim>& sites) {
  std::vector<int> nodes(sites.node_count());
  std::iota(nodes.begin(), nodes.end(), 0);
  std::sort(nodes.begin(), nodes.end(), [&](int a, int b) {
    const double first = squared_distance(sites, 0, a);
    const double second = squared_distance(sites, 0, b);
    if (first != second) return first < second;
    const double* x = sites.nodes.col(a).data();
    const double* y = sites.nodes.col(b).data();
    return std::lexicographical_compare(x, x + Dim, y, y + Dim);
  });
  return nodes;
}

/// Every node in the row of each point whose anchor is wanted.
template <int Dim>
Weights pattern(const Sites<Dim>& sites, int per_entry) {
  Weights weights;
  weights.per_entry = per_entry;
  std::vector<int> row(sites.node_count());
  int sorted_for = -1;
  for (int anchor : sites.point_anchor) {
    if (sites.wanted[anchor] != 0) {
      if (anchor != sorted_for) {
        std::iota(row.begin(), row.end(), 0);
        sort_stencil<Dim>(sites, anchor, row);
        sorted_for = anchor;
      }
      weights.columns.insert(weights.columns.end(), row.begin(), row.end());
    }
    weights.offsets.push_back(static_cast<std::int64_t>(weights.columns.size()));
  }
  weights.values.resize(weights.columns.size() * per_entry);
  return weights;
}

/// Copies the weights of derivative d at some points into their rows.
void scatter(const Eigen::MatrixXd& solution, const std::vector<int>& place,
             std::span<const int> points, int d, Weights& weights) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::span<const int> nodes = weights.nodes(points[i]);
    Eigen::Map<Eigen::MatrixXd> row = weights.row(points[i]);
    for (std::size_t j = 0; j < nodes.size(); ++j) {
      row(d, static_cast<Eigen::Index>(j)) =
          solution(place[nodes[j]], static_cast<Eigen::Index>(i));
    }
  }
}

/// Condition in the 2-norm of a symmetric matrix, much cheaper than by singular values.
double symmetric_condition(const Eigen::MatrixXd& matrix) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(matrix, Eigen::EigenvaluesOnly);
  const Eigen::VectorXd sizes = solver.eigenvalues().cwiseAbs();
  return sizes.minCoeff() > 0 ? sizes.maxCoeff() / sizes.minCoeff()
                              : std::numeric_limits<double>::infinity();
}

}  // namespace

template <int Dim>
typename GlobalInterpolation<Dim>::Whole GlobalInterpolation<Dim>::gather(
    const Sites<Dim>& sites) const {
  if (needs().spacing && sites.spacing.size() != sites.anchor_count()) {
    throw CaseError(name_ + ": the local spacing is needed but the sites hold none");
  }
  if (sites.node_count() > most_nodes) {
    throw SkipCase(fmt::format(
        "{}: {} nodes make a dense matrix that is too large; use at most {} nodes, or the local "
        "method rbf",
        name_, sites.node_count(), most_nodes));
  }
  Whole whole;
  whole.middle = 0.5 * (sites.nodes.rowwise().minCoeff() + sites.nodes.rowwise().maxCoeff());
  Sites<Dim> frame;
  frame.nodes = sites.nodes;
  frame.anchors = whole.middle;
  frame.anchor_node = {-1};
  if (needs().spacing) frame.spacing = Eigen::VectorXd::Constant(1, sites.spacing.mean());
  whole.nodes = sorted_nodes(frame);
  whole.place.resize(whole.nodes.size());
  for (std::size_t i = 0; i < whole.nodes.size(); ++i) {
    whole.place[whole.nodes[i]] = static_cast<int>(i);
  }
  const LocalOutcome outcome = whole.stencil.gather(frame, whole.nodes, 0);
  if (outcome == LocalOutcome::coincident) {
    throw CaseError(name_ + ": two nodes are at the same place; remove one of them");
  }
  if (outcome != LocalOutcome::ok || sites.node_count() < kernel_.needed_nodes()) {
    throw CaseError(fmt::format("{}: {} nodes are too few, at least {} are needed", name_,
                                sites.node_count(), kernel_.needed_nodes()));
  }
  return whole;
}

template <int Dim>
Weights GlobalInterpolation<Dim>::weights(const Sites<Dim>& sites, const Stencils& /*stencils*/,
                                          const Derivatives<Dim>& derivatives) const {
  refuse_spans<Dim>(sites, name_);
  const Whole whole = gather(sites);
  const LocalStencil<Dim>& stencil = whole.stencil;
  const Eigen::MatrixXd matrix = kernel_.local_matrix(stencil, Scaling::both);
  Factor factor;
  double error = 0;
  unsplit([&] {
    factor.compute(matrix);
    error = smooth_error<Dim>(factor, matrix, stencil);
  });
  if (!(error < smooth_tolerance)) {
    throw CaseError(
        fmt::format("{}: the matrix of {} nodes is singular to working precision (smooth nodal "
                    "values come back "
                    "with an error of {:.1e}); ask for a smaller shape parameter or fewer nodes",
                    name_, stencil.size, error));
  }
  Weights weights = pattern(sites, derivatives.size());
  std::vector<int> points;
  for (int p = 0; p < weights.size(); ++p) {
    if (!weights.nodes(p).empty()) points.push_back(p);
  }
  const int blocks = (static_cast<int>(points.size()) + block - 1) / block;
  ParallelErrors errors;
#pragma omp parallel
  {
    typename RadialInterpolation<Dim>::Workspace work;
    Eigen::MatrixXd solution(matrix.rows(), block);
#pragma omp for collapse(2) schedule(dynamic)
    for (int d = 0; d < derivatives.size(); ++d) {
      for (int b = 0; b < blocks; ++b) {
        errors.guard(b, [&] {
          const int count = std::min(block, static_cast<int>(points.size()) - b * block);
          const std::span<const int> chosen(points.data() + b * block, count);
          fill_right_hand_sides(sites, whole, chosen, derivatives, d, work, solution);
          solution = factor.solve(solution).eval();
          solution *= std::pow(stencil.radius, -order_of<Dim>(derivatives[d]));
          scatter(solution, whole.place, chosen, d, weights);
        });
      }
    }
  }
  errors.rethrow();
  return weights;
}

template <int Dim>
void GlobalInterpolation<Dim>::fill_right_hand_sides(
    const Sites<Dim>& sites, const Whole& whole, std::span<const int> points,
    const Derivatives<Dim>& derivatives, int d, typename RadialInterpolation<Dim>::Workspace& work,
    Eigen::MatrixXd& right) const {
  right.setZero();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Point<Dim> at = (sites.points.col(points[i]) - whole.middle) / whole.stencil.radius;
    kernel_.prepare(whole.stencil, work, at, derivatives);
    kernel_.fill_right_hand_side(whole.stencil, work, at, d,
                                 right.col(static_cast<Eigen::Index>(i)).data());
  }
}

template <int Dim>
std::vector<double> GlobalInterpolation<Dim>::condition(const Sites<Dim>& sites,
                                                        std::span<const int> anchors,
                                                        const Stencils& /*stencils*/,
                                                        Scaling scaling, ConditionNorm norm) const {
  const Whole whole = gather(sites);
  const Eigen::MatrixXd matrix = kernel_.local_matrix(whole.stencil, scaling);
  double value = 0;
  unsplit([&] {
    const bool symmetric = scaling == Scaling::both || kernel_.terms() == 0;
    value = norm == ConditionNorm::two && symmetric ? symmetric_condition(matrix)
                                                    : condition_number(matrix, norm);
  });
  return std::vector<double>(anchors.size(), value);
}

template class GlobalInterpolation<1>;
template class GlobalInterpolation<2>;
template class GlobalInterpolation<3>;

}  // namespace strongpoint
