#pragma once

#include <optional>
#include <span>
#include <vector>

#include "problems/core/face_makers.hpp"

namespace strongpoint {

/// Corners at which a domain's interior angle exceeds that of a straight side by three degrees or
/// more: ends of pieces whose tangent goes on inside the domain.
std::vector<Point<2>> reentrant_corners(const Domain<2>& domain);

/// What measures of cells near re-entrant corners share between threads.
template <int Dim>
struct ReentrantSetting {
  ReentrantSetting(const PointCloud<Dim>&, const Domain<Dim>&) {}
};

template <>
struct ReentrantSetting<2> {
  FaceSetting<2> faces;
  std::vector<Point<2>> corners;

  /// Both must outlive the setting.
  ReentrantSetting(const PointCloud<2>& cloud, const Domain<2>& domain)
      : faces(cloud, domain, 2), corners(reentrant_corners(domain)) {}
};

/// Measures the cells near re-entrant corners by their outlines: half planes would cut off what
/// lies beyond the corner. In 1D there are none, in 3D they are not looked for.
template <int Dim>
class ReentrantCells {
 public:
  explicit ReentrantCells(const ReentrantSetting<Dim>&) {}
  /// The extent of a cell, or nothing when it is not near such a corner. Neighbours are sorted by
  /// distance, and all nodes up to `reach` are among them.
  std::optional<CellExtent> measure(int, std::span<const int>, double) { return std::nullopt; }
};

template <>
class ReentrantCells<2> {
 public:
  /// The setting must outlive the cells.
  explicit ReentrantCells(const ReentrantSetting<2>& setting)
      : setting_(setting), maker_(setting.faces) {}
  /// As above. Throws CaseError, naming the node, when the boundary inside its cell could not be
  /// followed.
  std::optional<CellExtent> measure(int node, std::span<const int> neighbours, double reach);

 private:
  const ReentrantSetting<2>& setting_;
  FaceMaker<2> maker_;
  std::vector<FacePoint<2>> points_;

  bool is_near_corner(const Point<2>& x, double reach) const;
};

}  // namespace strongpoint
