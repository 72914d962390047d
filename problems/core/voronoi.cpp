#include "problems/core/voronoi.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <vector>

#include <fmt/format.h>

#include "methods/core/error.hpp"
#include "methods/core/parallel_errors.hpp"
#include "problems/core/convex_cell.hpp"

namespace strongpoint {
namespace {

/// Neighbours tried first, by dimension, the node included: settling a cell takes all nodes within
/// twice its radius, some three times as many as it has faces.
constexpr int first_neighbours[] = {0, 6, 20, 48};

/// Cells made between two searches: bounds the memory of their neighbour lists.
constexpr std::size_t batch_size = 32768;

/// Clips by tangent planes before a convex curved side counts as followed; each round divides the
/// overshoot of a corner by four.
constexpr int domain_rounds = 24;

/// Overshoot of a vertex beyond the boundary, relative to the cell's radius, that is round-off.
constexpr double overshoot_tolerance = 1e-12;

/// Cosine above which a numerical normal is that of a side: finite differences are this good, and a
/// normal that a corner of the domain tilts is not.
constexpr double same_normal = 1 - 1e-7;

/// A supporting plane of the domain.
template <int Dim>
struct TangentPlane {
  Point<Dim> foot, normal;
};

/// Gradient of the distance by central differences.
template <int Dim>
Point<Dim> distance_gradient(const Domain<Dim>& domain, const Point<Dim>& x, double step) {
  Point<Dim> gradient;
  for (int c = 0; c < Dim; ++c) {
    Point<Dim> ahead = x;
    Point<Dim> behind = x;
    ahead[c] += step;
    behind[c] -= step;
    gradient[c] = (domain.distance(ahead) - domain.distance(behind)) / (ahead[c] - behind[c]);
  }
  return gradient;
}

/// The exact normal of the side whose normal at x is almost `numerical`, or `numerical` when there
/// is no such side.
template <int Dim>
Point<Dim> exact_normal(const Domain<Dim>& domain, const Point<Dim>& x,
                        const Point<Dim>& numerical) {
  Point<Dim> best = numerical;
  double best_cosine = same_normal;
  for (int side = 0; side < static_cast<int>(domain.sides().size()); ++side) {
    const Point<Dim> normal = domain.normal(side, x);
    const double cosine = normal.dot(numerical);
    if (!(cosine > best_cosine)) continue;
    best_cosine = cosine;
    best = normal;
  }
  return best;
}

/// The plane that touches the domain nearest to a position outside it. Lengths are small or large
/// relative to `scale`. A normal of zeros means that there is none.
template <int Dim>
TangentPlane<Dim> tangent_plane(const Domain<Dim>& domain, const Point<Dim>& x, double scale) {
  TangentPlane<Dim> plane{x, Point<Dim>::Zero()};
  double distance = domain.distance(x);
  for (int step = 0; step == 0 || (step < 30 && distance > 1e-7 * scale); ++step) {
    const double width = std::clamp(0.1 * distance, 1e-6 * scale, 1e-2 * scale);
    const Point<Dim> gradient = distance_gradient(domain, plane.foot, width);
    const double slope = gradient.norm();
    if (!(slope > 0.1)) return {x, Point<Dim>::Zero()};
    plane.normal = exact_normal<Dim>(domain, plane.foot, gradient / slope);
    const Point<Dim> foot = plane.foot - distance / slope * plane.normal;
    const double left = domain.distance(foot);
    if (std::abs(left) <= overshoot_tolerance * scale) return {foot, plane.normal};
    // Off a corner the gradient turns as one comes near: stay outside and look again from there, so
    // that the plane ends in the corner and does not cut it off.
    plane.foot -= 0.9 * distance / slope * plane.normal;
    distance = domain.distance(plane.foot);
  }
  plane.foot -= distance * plane.normal;
  return plane;
}

/// Makes cells one after the other in the same memory.
template <int Dim>
class CellMaker {
 public:
  CellMaker(const PointCloud<Dim>& cloud, const Domain<Dim>& domain)
      : cloud_(cloud), domain_(domain) {}

  /// Measure of the cell of a node, given its nearest nodes; NaN when farther nodes might cut it.
  double measure(int node, std::span<const int> neighbours) {
    const Point<Dim> centre = cloud_.nodes.col(node);
    const double reach = (cloud_.nodes.col(neighbours.back()) - centre).norm();
    if (static_cast<int>(neighbours.size()) == cloud_.size())
      return last_measure(node, neighbours, reach);
    // Nodes beyond reach cannot cut what lies within half of it, and a cell that touches this box
    // does not; so the box never shows in a cell that counts.
    make(node, neighbours, 0.5 * (1 + 1e-9) * reach);
    const bool settled = 4 * farthest_squared(cell_) <= reach * reach;
    return settled ? cell_.measure() : std::numeric_limits<double>::quiet_NaN();
  }

 private:
  const PointCloud<Dim>& cloud_;
  const Domain<Dim>& domain_;
  ConvexCell<Dim> cell_;

  /// The measure with all nodes known: now the domain alone bounds the cell, and the box must hold
  /// it.
  double last_measure(int node, std::span<const int> neighbours, double reach) {
    for (double half = 2 * reach; std::isfinite(half * half); half *= 4) {
      make(node, neighbours, half);
      if (farthest_squared(cell_) < half * half) return cell_.measure();
      if (!(half > 0)) break;
    }
    return std::numeric_limits<double>::infinity();
  }

  /// The cell within a box of the given half width around the node.
  void make(int node, std::span<const int> neighbours, double half_width) {
    const Point<Dim> half = Point<Dim>::Constant(half_width);
    cell_.reset(-half, half);
    for (const BoundaryMark<Dim>& mark : cloud_.marks_of(node)) cell_.clip(mark.normal, 0);
    clip_by_neighbours(node, neighbours);
    clip_by_domain(cloud_.nodes.col(node));
  }

  void clip_by_neighbours(int node, std::span<const int> neighbours) {
    double security = 4 * farthest_squared(cell_);
    for (int neighbour : neighbours) {
      if (neighbour == node) continue;
      const Point<Dim> arm = cloud_.nodes.col(neighbour) - cloud_.nodes.col(node);
      const double length = arm.norm();
      if (length * length > security) return;
      if (cell_.clip(arm / length, length / 2) != Clip::untouched) {
        security = 4 * farthest_squared(cell_);
      }
    }
  }

  void clip_by_domain(const Point<Dim>& centre) {
    double scale = std::sqrt(farthest_squared(cell_));
    if (-domain_.distance(centre) > scale) return;
    for (int round = 0; round < domain_rounds; ++round) {
      const double tolerance = overshoot_tolerance * scale;
      double overshoot = tolerance;
      Point<Dim> worst = Point<Dim>::Zero();
      for (const Point<Dim>& v : cell_.vertices()) {
        const double distance = domain_.distance(centre + v);
        if (!(distance > overshoot)) continue;
        overshoot = distance;
        worst = v;
      }
      if (overshoot == tolerance) return;
      const TangentPlane<Dim> plane = tangent_plane<Dim>(domain_, centre + worst, scale);
      const Clip outcome = cell_.clip(plane.normal, plane.normal.dot(plane.foot - centre));
      if (outcome != Clip::cut) return;
      scale = std::sqrt(farthest_squared(cell_));
    }
  }
};

/// Measures of the cells of some nodes, NaN where k neighbours do not settle them.
template <int Dim>
std::vector<double> measures_of(const PointCloud<Dim>& cloud, const Domain<Dim>& domain,
                                std::span<const int> nodes, const Stencils& neighbours) {
  std::vector<double> measures(nodes.size());
  ParallelErrors errors;
#pragma omp parallel
  {
    CellMaker<Dim> maker(cloud, domain);
#pragma omp for schedule(dynamic, 64)
    for (int i = 0; i < static_cast<int>(nodes.size()); ++i) {
      errors.guard(i, [&] { measures[i] = maker.measure(nodes[i], neighbours[i]); });
    }
  }
  errors.rethrow();
  return measures;
}

/// Tries the cells of `pending` with k neighbours each; returns the nodes that need more.
template <int Dim>
std::vector<int> settle(const PointCloud<Dim>& cloud, const Domain<Dim>& domain,
                        const NeighbourSearch<Dim>& search, std::span<const int> pending, int k,
                        Eigen::VectorXd& volumes) {
  std::vector<int> open;
  for (std::size_t start = 0; start < pending.size(); start += batch_size) {
    const std::span<const int> nodes =
        pending.subspan(start, std::min(batch_size, pending.size() - start));
    const Stencils neighbours = search.nearest(columns_of<Dim>(cloud.nodes, nodes), k, Ties::cut);
    const std::vector<double> measures = measures_of<Dim>(cloud, domain, nodes, neighbours);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      volumes[nodes[i]] = measures[i];
      if (std::isnan(measures[i])) open.push_back(nodes[i]);
    }
  }
  return open;
}

}  // namespace

template <int Dim>
Eigen::VectorXd voronoi_volumes(const PointCloud<Dim>& cloud, const Domain<Dim>& domain,
                                const NeighbourSearch<Dim>& search) {
  const int count = cloud.size();
  Eigen::VectorXd volumes(count);
  std::vector<int> pending(static_cast<std::size_t>(count));
  std::iota(pending.begin(), pending.end(), 0);
  int k = std::min(first_neighbours[Dim], count);
  while (!pending.empty()) {
    pending = settle(cloud, domain, search, pending, k, volumes);
    if (k == count) break;
    k = static_cast<int>(std::min<std::int64_t>(2 * static_cast<std::int64_t>(k), count));
  }
  for (int i = 0; i < count; ++i) {
    if (volumes[i] > 0 && std::isfinite(volumes[i])) continue;
    throw CaseError(
        fmt::format("the Voronoi cell of node {} at {} has measure {:g}: move the node into the "
                    "domain, or remove "
                    "the nodes that coincide with it",
                    i, format_point(cloud.nodes.col(i)), volumes[i]));
  }
  return volumes;
}

template Eigen::VectorXd voronoi_volumes<1>(const PointCloud<1>&, const Domain<1>&,
                                            const NeighbourSearch<1>&);
template Eigen::VectorXd voronoi_volumes<2>(const PointCloud<2>&, const Domain<2>&,
                                            const NeighbourSearch<2>&);
template Eigen::VectorXd voronoi_volumes<3>(const PointCloud<3>&, const Domain<3>&,
                                            const NeighbourSearch<3>&);

}  // namespace strongpoint
