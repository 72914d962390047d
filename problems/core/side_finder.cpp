#include "problems/core/side_finder.hpp"

#include <limits>
#include <span>

namespace strongpoint {
namespace {

/// Cosine above which a side's normal is that of a point between nodes of the side.
constexpr double fitting_normal = 0.99;

/// Difference of cosines that does not tell two sides apart.
constexpr double same_cosine = 1e-9;

/// The side among some whose normal is nearest to one given.
struct BestSide {
  int side = -1;
  double cosine = -2;
  bool is_tied = false;

  void offer(int candidate, double its_cosine) {
    if (its_cosine > cosine + same_cosine) {
      side = candidate;
      cosine = its_cosine;
      is_tied = false;
    } else if (candidate != side && its_cosine > cosine - same_cosine) {
      is_tied = true;
    }
  }
};

BestSide best_mark(const Domain<2>& domain, std::span<const BoundaryMark<2>> marks,
                   const Point<2>& x, const Point<2>& normal) {
  BestSide best;
  for (const BoundaryMark<2>& mark : marks) {
    best.offer(mark.side, domain.normal(mark.side, x).dot(normal));
  }
  return best;
}

}  // namespace

int SideFinder::side_at(const Point<2>& x, const Point<2>& normal) const {
  const BestSide own = best_mark(domain, cloud.marks_of(node), x, normal);
  const bool own_fits = own.cosine > fitting_normal;
  if (own_fits && !own.is_tied) return own.side;
  const int neighbour = nearest_marked_neighbour(x);
  if (neighbour >= 0) {
    const BestSide near = best_mark(domain, cloud.marks_of(neighbour), x, normal);
    if (near.cosine > fitting_normal) return near.side;
  }
  if (own_fits) return own.side;
  BestSide any;
  for (int side = 0; side < static_cast<int>(domain.sides().size()); ++side) {
    any.offer(side, domain.normal(side, x).dot(normal));
  }
  return any.side;
}

/// The node beyond an edge of the polygon that lies on the boundary and is nearest to x, or -1.
int SideFinder::nearest_marked_neighbour(const Point<2>& x) const {
  int nearest = -1;
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < static_cast<int>(polygon.vertices().size()); ++i) {
    const int neighbour = polygon.label(i);
    if (neighbour < 0 || !cloud.is_boundary(neighbour)) continue;
    const double distance = (cloud.nodes.col(neighbour) - x).squaredNorm();
    if (distance >= least) continue;
    least = distance;
    nearest = neighbour;
  }
  return nearest;
}

}  // namespace strongpoint
