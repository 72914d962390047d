#include "problems/core/cell_maker.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "problems/core/distance_gradient.hpp"

namespace strongpoint {
namespace {

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
  Point<Dim> foot;
  BoundaryMark<Dim> side;  ///< the side it touches, with the plane's normal
};

/// The side whose normal at x is nearest to `numerical`, with its exact normal where that is almost
/// the same and `numerical` itself where no side fits.
template <int Dim>
BoundaryMark<Dim> fitting_side(const Domain<Dim>& domain, const Point<Dim>& x,
                               const Point<Dim>& numerical) {
  BoundaryMark<Dim> best{0, numerical};
  double best_cosine = -2;
  for (int side = 0; side < static_cast<int>(domain.sides().size()); ++side) {
    const Point<Dim> normal = domain.normal(side, x);
    const double cosine = normal.dot(numerical);
    if (!(cosine > best_cosine)) continue;
    best_cosine = cosine;
    best = {side, cosine > same_normal ? normal : numerical};
  }
  return best;
}

/// The plane that touches the domain nearest to a position outside it. Lengths are small or large
/// relative to `scale`. A normal of zeros means that there is none.
template <int Dim>
TangentPlane<Dim> tangent_plane(const Domain<Dim>& domain, const Point<Dim>& x, double scale) {
  TangentPlane<Dim> plane{x, {0, Point<Dim>::Zero()}};
  double distance = domain.distance(x);
  for (int step = 0; step == 0 || (step < 30 && distance > 1e-7 * scale); ++step) {
    const double width = std::clamp(0.1 * distance, 1e-6 * scale, 1e-2 * scale);
    const Point<Dim> gradient = distance_gradient(domain, plane.foot, width);
    const double slope = gradient.norm();
    if (!(slope > 0.1)) return {x, {0, Point<Dim>::Zero()}};
    plane.side = fitting_side<Dim>(domain, plane.foot, gradient / slope);
    const Point<Dim> foot = plane.foot - distance / slope * plane.side.normal;
    const double left = domain.distance(foot);
    if (std::abs(left) <= overshoot_tolerance * scale) return {foot, plane.side};
    // Off a corner the gradient turns as one comes near: stay outside and look again from there, so
    // that the plane ends in the corner and does not cut it off.
    plane.foot -= 0.9 * distance / slope * plane.side.normal;
    distance = domain.distance(plane.foot);
  }
  plane.foot -= distance * plane.side.normal;
  return plane;
}

/// A cell kept as its vertices and faces, to be clipped.
template <int Dim>
struct WholeCell {
  ConvexCell<Dim>& cell;

  double farthest_squared() const { return strongpoint::farthest_squared(cell); }
  int size() const { return static_cast<int>(cell.vertices().size()); }
  Point<Dim> vertex(int v) const { return cell.vertices()[v]; }
  bool clip(const Point<Dim>& normal, double offset, int label) {
    return cell.clip(normal, offset, label) == Clip::cut;
  }
};

/// A cell kept as the kernel cuts it.
struct KernelCell {
  CutCell& cell;
  CutState state = CutState::whole;

  double farthest_squared() const {
    return *std::max_element(cell.squared, cell.squared + cell.vertices);
  }
  int size() const { return cell.vertices; }
  Point<3> vertex(int v) const { return {cell.x[v], cell.y[v], cell.z[v]}; }
  bool clip(const Point<3>& normal, double offset, int label) {
    const int faces = cell.faces;
    cut_further({&cell, {{normal[0], normal[1], normal[2]}, label}, offset, &state});
    return state == CutState::whole && cell.faces > faces;
  }
};

/// Clips a cell by tangent planes where it leaves the domain most, until it does not.
template <int Dim, class Cell>
void clip_cell_by_domain(const Domain<Dim>& domain, const Point<Dim>& centre, Cell& cell) {
  double scale = std::sqrt(cell.farthest_squared());
  if (-domain.distance(centre) > scale) return;
  for (int round = 0; round < domain_rounds; ++round) {
    const double tolerance = overshoot_tolerance * scale;
    double overshoot = tolerance;
    Point<Dim> worst = Point<Dim>::Zero();
    for (int v = 0; v < cell.size(); ++v) {
      const Point<Dim> x = cell.vertex(v);
      const double distance = domain.distance(centre + x);
      if (!(distance > overshoot)) continue;
      overshoot = distance;
      worst = x;
    }
    if (overshoot == tolerance) return;
    const TangentPlane<Dim> plane = tangent_plane<Dim>(domain, centre + worst, scale);
    const Point<Dim>& normal = plane.side.normal;
    const double offset = normal.dot(plane.foot - centre);
    if (!cell.clip(normal, offset, side_label(plane.side.side))) return;
    scale = std::sqrt(cell.farthest_squared());
  }
}

}  // namespace

template <int Dim>
CellState CellMaker<Dim>::make(int node, std::span<const int> neighbours, double reach) {
  if (static_cast<int>(neighbours.size()) < cloud_.size()) {
    clip(node, neighbours, box_for(reach));
    return 4 * farthest_squared(cell_) <= reach * reach ? CellState::settled : CellState::open;
  }
  // With all nodes known the domain alone bounds the cell, and the box must hold it.
  for (double half = 2 * reach; std::isfinite(half * half); half *= 4) {
    clip(node, neighbours, half);
    if (farthest_squared(cell_) < half * half) return CellState::settled;
    if (!(half > 0)) break;
  }
  return CellState::unbounded;
}

template <int Dim>
void CellMaker<Dim>::make_unclipped(int node, std::span<const int> neighbours, double half_width) {
  if (cut(node, neighbours, half_width, {})) return;
  const Point<Dim> half = Point<Dim>::Constant(half_width);
  cell_.reset(-half, half);
  clip_by_neighbours(node, neighbours);
}

template <int Dim>
void CellMaker<Dim>::clip(int node, std::span<const int> neighbours, double half_width) {
  // Marks first: a smaller cell has a smaller security radius.
  if (!cut(node, neighbours, half_width, cloud_.marks_of(node))) {
    const Point<Dim> half = Point<Dim>::Constant(half_width);
    cell_.reset(-half, half);
    clip_by_marks(node);
    clip_by_neighbours(node, neighbours);
  }
  clip_by_domain(cloud_.nodes.col(node));
}

/// In space: cuts the cell by the marks and the neighbours the fast way, false where that fails.
template <int Dim>
bool CellMaker<Dim>::cut(int node, std::span<const int> neighbours, double half_width,
                         std::span<const BoundaryMark<Dim>> marks) {
  if constexpr (Dim == 3) {
    if (!cut_fast(node, neighbours, half_width, marks)) return false;
    cell_.assign(work_);
    return true;
  } else {
    return false;
  }
}

/// The same, leaving the cell where it was cut.
template <int Dim>
bool CellMaker<Dim>::cut_fast(int node, std::span<const int> neighbours, double half_width,
                              std::span<const BoundaryMark<Dim>> marks) {
  if constexpr (Dim == 3) {
    side_planes_.clear();
    for (const BoundaryMark<3>& mark : marks) {
      side_planes_.push_back(
          {{mark.normal[0], mark.normal[1], mark.normal[2]}, side_label(mark.side)});
    }
    const std::array<std::int64_t, 2> offsets{0, static_cast<std::int64_t>(neighbours.size())};
    double farthest = 0;
    CutState state = CutState::broken;
    cut_cells({cloud_.nodes.data(), &node, offsets.data(), neighbours.data(), 1,
               side_planes_.data(), static_cast<int>(side_planes_.size()), &half_width, &work_,
               nullptr, &farthest, &state});
    return state == CutState::whole;
  } else {
    return false;
  }
}

template <int Dim>
void CellMaker<Dim>::clip_to_domain(int node) {
  clip_by_marks(node);
  clip_by_domain(cloud_.nodes.col(node));
}

template <int Dim>
void CellMaker<Dim>::clip_by_marks(int node) {
  for (const BoundaryMark<Dim>& mark : cloud_.marks_of(node)) {
    cell_.clip(mark.normal, 0, side_label(mark.side));
  }
}

template <int Dim>
void CellMaker<Dim>::clip_by_neighbours(int node, std::span<const int> neighbours) {
  double security = 4 * farthest_squared(cell_);
  for (int neighbour : neighbours) {
    if (neighbour == node) continue;
    const Point<Dim> arm = cloud_.nodes.col(neighbour) - cloud_.nodes.col(node);
    const double length = arm.norm();
    if (length * length > security) return;
    if (cell_.clip(arm / length, length / 2, neighbour) != Clip::untouched) {
      security = 4 * farthest_squared(cell_);
    }
  }
}

template <int Dim>
void CellMaker<Dim>::clip_by_domain(const Point<Dim>& centre) {
  WholeCell<Dim> cell{cell_};
  clip_cell_by_domain<Dim>(domain_, centre, cell);
}

template <int Dim>
CellExtent CellMaker<Dim>::measure(int node, std::span<const int> neighbours, double reach) {
  CellExtent extent{CellState::open, 0, 0};
  if (static_cast<int>(neighbours.size()) < cloud_.size() &&
      measure_fast(node, neighbours, box_for(reach), extent)) {
    if (4 * extent.farthest_squared <= reach * reach) extent.state = CellState::settled;
    return extent;
  }
  extent.state = make(node, neighbours, reach);
  extent.measure = extent.state == CellState::unbounded ? std::numeric_limits<double>::infinity()
                                                        : cell_.measure();
  extent.farthest_squared = farthest_squared(cell_);
  return extent;
}

/// In space: makes and measures the cell where it is cut, false where that fails.
template <int Dim>
bool CellMaker<Dim>::measure_fast(int node, std::span<const int> neighbours, double half_width,
                                  CellExtent& extent) {
  if constexpr (Dim == 3) {
    if (!cut_fast(node, neighbours, half_width, cloud_.marks_of(node))) return false;
    KernelCell cell{work_};
    clip_cell_by_domain<3>(domain_, cloud_.nodes.col(node), cell);
    if (cell.state == CutState::broken) return false;
    measure_cell({&work_, &extent.measure, &extent.farthest_squared});
    return true;
  } else {
    return false;
  }
}

template class CellMaker<1>;
template class CellMaker<2>;
template class CellMaker<3>;

}  // namespace strongpoint
