#include "problems/core/face_makers.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "methods/core/error.hpp"

namespace strongpoint {
namespace {

/// Difference of the normals of two nodes on one side by which it counts as curved.
constexpr double flat_tolerance = 1e-12;

/// Height above a flat side, relative to the cell, that is round-off.
constexpr double height_tolerance = 1e-12;

/// No curved side, or more than one, near a cell.
enum SideNear { no_side = -1, several_sides = -2 };

/// Finds the sides on which the normals of nodes differ.
template <int Dim>
std::vector<char> find_curved_sides(const PointCloud<Dim>& cloud, std::size_t sides) {
  std::vector<char> is_curved(sides, 0);
  std::vector<const Point<Dim>*> normals(sides, nullptr);
  for (const BoundaryMark<Dim>& mark : cloud.marks) {
    const Point<Dim>*& first = normals[mark.side];
    if (first == nullptr) first = &mark.normal;
    if ((mark.normal - *first).norm() > flat_tolerance) is_curved[mark.side] = 1;
  }
  return is_curved;
}

}  // namespace

template <>
FaceSetting<1>::FaceSetting(const PointCloud<1>& its_cloud, const Domain<1>& its_domain,
                            int its_gauss)
    : cloud(its_cloud), domain(its_domain), gauss(its_gauss) {}

template <>
FaceSetting<2>::FaceSetting(const PointCloud<2>& its_cloud, const Domain<2>& its_domain,
                            int its_gauss)
    : cloud(its_cloud),
      domain(its_domain),
      gauss(its_gauss),
      corners(boundary_corners(its_cloud, its_domain)) {}

template <>
FaceSetting<3>::FaceSetting(const PointCloud<3>& its_cloud, const Domain<3>& its_domain,
                            int its_gauss)
    : cloud(its_cloud),
      domain(its_domain),
      gauss(its_gauss),
      is_curved(find_curved_sides(its_cloud, its_domain.sides().size())) {}

double FaceMaker<1>::add(int node, std::span<const int> neighbours, double half,
                         std::vector<FacePoint<1>>& points) {
  maker_.make_unclipped(node, neighbours, half);
  maker_.clip_to_domain(node);
  add_ends(maker_.cell(), cloud_.nodes.col(node), points);
  return std::sqrt(farthest_squared(maker_.cell()));
}

double FaceMaker<2>::add(int node, std::span<const int> neighbours, double half,
                         std::vector<FacePoint<2>>& points) {
  maker_.make_unclipped(node, neighbours, half);
  return outline_.add(node, maker_.cell(), points);
}

void FaceMaker<2>::check(int node) const {
  if (!outline_.is_broken()) return;
  throw CaseError(fmt::format(
      "the boundary inside the Voronoi cell of node {} at {} could not be followed: put "
      "more nodes on the boundary there, or refine the cloud",
      cloud_.number_of(node), format_point(cloud_.nodes.col(node))));
}

double FaceMaker<3>::add(int node, std::span<const int> neighbours, double half,
                         std::vector<FacePoint<3>>& points) {
  maker_.make_unclipped(node, neighbours, half);
  const Point<3> centre = setting_.cloud.nodes.col(node);
  const int side = curved_side_near(node);
  if (side >= 0 && clip_by_flat_sides(node)) {
    const auto reach = curved_.add(maker_.cell(), centre, side, points);
    if (reach) return *reach;
  }
  maker_.clip_to_domain(node);
  add_faces(maker_.cell(), centre, rule_, corners_, points);
  return std::sqrt(farthest_squared(maker_.cell()));
}

/// The curved side that the node or nodes beyond its faces lie on, if it is only one. Leaves those
/// of them that lie on any side in `near_`.
int FaceMaker<3>::curved_side_near(int node) {
  near_.assign(1, node);
  const ConvexCell<3>& cell = maker_.cell();
  for (int face = 0; face < cell.face_count(); ++face) {
    const int neighbour = cell.label(face);
    if (neighbour >= 0 && setting_.cloud.is_boundary(neighbour)) near_.push_back(neighbour);
  }
  int found = no_side;
  for (int near : near_) {
    for (const BoundaryMark<3>& mark : setting_.cloud.marks_of(near)) {
      if (setting_.is_curved[mark.side] == 0 || mark.side == found) continue;
      found = found == no_side ? mark.side : several_sides;
    }
  }
  return found;
}

/// Clips the cell by the flat sides of the nodes near; false when one of them does not bound it.
bool FaceMaker<3>::clip_by_flat_sides(int node) {
  for (int near : near_) {
    for (const BoundaryMark<3>& mark : setting_.cloud.marks_of(near)) {
      if (setting_.is_curved[mark.side] != 0) continue;
      if (!clip_by_flat_side(node, setting_.cloud.nodes.col(near), mark)) return false;
    }
  }
  return true;
}

/// Clips the cell by the plane of a side; false when that would cut off some of the domain.
bool FaceMaker<3>::clip_by_flat_side(int node, const Point<3>& foot, const BoundaryMark<3>& mark) {
  ConvexCell<3>& cell = maker_.cell();
  const Point<3> centre = setting_.cloud.nodes.col(node);
  const double offset = mark.normal.dot(foot - centre);
  const double round_off = height_tolerance * std::sqrt(farthest_squared(cell));
  if (offset < -round_off) return false;
  for (const Point<3>& v : cell.vertices()) {
    if (mark.normal.dot(v) - offset <= round_off) continue;
    if (setting_.domain.distance(centre + v) < -round_off) return false;
  }
  cell.clip(mark.normal, offset, side_label(mark.side));
  return true;
}

}  // namespace strongpoint
