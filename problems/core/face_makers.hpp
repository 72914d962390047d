#pragma once

#include <cmath>
#include <limits>
#include <vector>

#include "problems/core/cell_maker.hpp"
#include "problems/core/cell_outline.hpp"
#include "problems/core/curved_cell.hpp"
#include "problems/core/polyhedron_faces.hpp"

namespace strongpoint {

/// What the makers of faces share between threads.
template <int Dim>
struct FaceSetting {
  const PointCloud<Dim>& cloud;
  const Domain<Dim>& domain;
  int gauss;
  std::vector<Point<2>> corners;  ///< 2D: where sides meet
  std::vector<char> is_curved;    ///< 3D: by side, whether nodes on it differ in their normals

  /// Cloud and domain must outlive the setting.
  FaceSetting(const PointCloud<Dim>& its_cloud, const Domain<Dim>& its_domain, int its_gauss);
};

/// What became of a cell, and how far it reaches.
struct CellOutcome {
  CellState state;
  double farthest;
};

/// Appends the points of a node's cell once its neighbours, all nodes up to `reach`, settle it. A
/// maker is called as `maker.add(node, neighbours, half_width, points)`, makes the cell within a
/// box and returns how far the cell reaches; `maker.check(node)` throws CaseError when it is not
/// sound.
template <int Dim, class Maker>
CellOutcome add_settled(const PointCloud<Dim>& cloud, Maker& maker, int node,
                        std::span<const int> neighbours, double reach,
                        std::vector<FacePoint<Dim>>& points) {
  if (static_cast<int>(neighbours.size()) < cloud.size()) {
    const double farthest = maker.add(node, neighbours, box_for(reach), points);
    if (2 * farthest > reach) return {CellState::open, farthest};
    maker.check(node);
    return {CellState::settled, farthest};
  }
  // With all nodes known the domain alone bounds the cell, and the box must hold it.
  for (double half = 2 * reach; std::isfinite(half * half) && half > 0; half *= 4) {
    const std::size_t before = points.size();
    const double farthest = maker.add(node, neighbours, half, points);
    if (farthest < half) {
      maker.check(node);
      return {CellState::settled, farthest};
    }
    points.resize(before);
  }
  return {CellState::unbounded, std::numeric_limits<double>::infinity()};
}

/// Makes the faces of cells, one after the other in the same memory.
template <int Dim>
class FaceMaker;

/// In 1D: the ends of intervals.
template <>
class FaceMaker<1> {
 public:
  /// The setting must outlive the maker.
  explicit FaceMaker(const FaceSetting<1>& setting)
      : cloud_(setting.cloud), maker_(setting.cloud, setting.domain) {}
  /// Appends the points of a cell within a box; returns how far it reaches.
  double add(int node, std::span<const int> neighbours, double half,
             std::vector<FacePoint<1>>& points);
  /// Does nothing: such cells are sound.
  void check(int) const {}

 private:
  const PointCloud<1>& cloud_;
  CellMaker<1> maker_;
};

/// In 2D: the polygon of bisectors, its outline inside the domain.
template <>
class FaceMaker<2> {
 public:
  /// The setting must outlive the maker.
  explicit FaceMaker(const FaceSetting<2>& setting)
      : cloud_(setting.cloud),
        maker_(setting.cloud, setting.domain),
        outline_(setting.cloud, setting.domain, setting.corners, setting.gauss) {}
  /// Appends the points of a cell within a box; returns how far it reaches.
  double add(int node, std::span<const int> neighbours, double half,
             std::vector<FacePoint<2>>& points);
  /// Throws CaseError, naming the node, when the boundary inside its cell could not be followed.
  void check(int node) const;

 private:
  const PointCloud<2>& cloud_;
  CellMaker<2> maker_;
  CellOutline outline_;
};

/// In 3D: polyhedra, along one curved side those of `CurvedCell`, else cut by tangent planes.
template <>
class FaceMaker<3> {
 public:
  /// The setting must outlive the maker.
  explicit FaceMaker(const FaceSetting<3>& setting)
      : setting_(setting),
        maker_(setting.cloud, setting.domain),
        rule_(setting.gauss),
        curved_(setting.domain, rule_) {}
  FaceMaker(const FaceMaker& other) : FaceMaker(other.setting_) {}
  FaceMaker& operator=(const FaceMaker&) = delete;
  ~FaceMaker() = default;
  /// Appends the points of a cell within a box; returns how far it reaches.
  double add(int node, std::span<const int> neighbours, double half,
             std::vector<FacePoint<3>>& points);
  /// Does nothing: such cells are sound.
  void check(int) const {}

 private:
  const FaceSetting<3>& setting_;
  CellMaker<3> maker_;
  PolygonRule rule_;
  CurvedCell curved_;              ///< uses the rule
  std::vector<int> near_;          ///< the node and its neighbours on the boundary
  std::vector<Point<3>> corners_;  ///< of a face

  int curved_side_near(int node);
  bool clip_by_flat_sides(int node);
  bool clip_by_flat_side(int node, const Point<3>& foot, const BoundaryMark<3>& mark);
};

}  // namespace strongpoint
