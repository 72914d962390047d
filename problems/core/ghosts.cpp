#include "problems/core/ghosts.hpp"

#include <fmt/format.h>

#include "methods/core/error.hpp"
#include "problems/core/mirror.hpp"

namespace strongpoint {
namespace {

/// A ghost closer to a node than this fraction of the spacing makes stencils degenerate.
constexpr double too_close = 0.05;

/// True when some field's flux is known at the node, and not its value by another side.
template <int Dim>
bool has_flux_condition(const FluxProblem<Dim>& problem, std::span<const BoundaryMark<Dim>> marks) {
  const int fields = static_cast<int>(problem.fields().size());
  for (int f = 0; f < fields; ++f) {
    if (!problem.has_flux(f)) continue;
    bool has_value = false;
    for (const BoundaryMark<Dim>& mark : marks) {
      has_value = has_value || problem.known(f, mark.side) == Known::value;
    }
    if (!has_value) return true;
  }
  return false;
}

template <int Dim>
bool gives_no_value(const FluxProblem<Dim>& problem, int side) {
  const int fields = static_cast<int>(problem.fields().size());
  for (int f = 0; f < fields; ++f) {
    if (problem.has_flux(f) && problem.known(f, side) == Known::value) return false;
  }
  return true;
}

/// The direction in which a node's ghost lies, of unit length: within the mirrored planes through
/// the node, where what a plane reverses is zero at the ghost too.
template <int Dim>
Point<Dim> outward(const FluxProblem<Dim>& problem, std::span<const BoundaryMark<Dim>> marks,
                   const std::vector<SymmetryPlane>& planes) {
  Point<Dim> loaded = Point<Dim>::Zero();
  Point<Dim> all = Point<Dim>::Zero();
  for (const BoundaryMark<Dim>& mark : marks) {
    if (lies_on_planes_only<Dim>({&mark, 1}, planes)) continue;
    all += mark.normal;
    if (gives_no_value(problem, mark.side)) loaded += mark.normal;
  }
  for (const BoundaryMark<Dim>& mark : marks) {
    for (const SymmetryPlane& plane : planes) {
      if (plane.side == mark.side) loaded[plane.axis] = all[plane.axis] = 0;
    }
  }
  return loaded.norm() > 1e-3 ? loaded.normalized() : all.normalized();
}

}  // namespace

template <int Dim>
Ghosts<Dim> prepared_ghosts(const PointCloud<Dim>& cloud, const NeighbourSearch<Dim>& search) {
  Ghosts<Dim> ghosts;
  ghosts.of_node.assign(cloud.size(), -1);
  ghosts.spacing.resize(cloud.size());
  const Stencils near = search.nearest(cloud.nodes, Dim + 2, Ties::cut);
  for (int i = 0; i < cloud.size(); ++i) {
    double sum = 0;
    for (int j : near[i]) sum += (cloud.nodes.col(j) - cloud.nodes.col(i)).norm();
    ghosts.spacing[i] = sum / std::max<double>(1, static_cast<double>(near[i].size()) - 1);
  }
  return ghosts;
}

template <int Dim>
void place_ghosts(const FluxProblem<Dim>& problem, const PointCloud<Dim>& cloud,
                  const std::vector<SymmetryPlane>& planes, Sites<Dim>& sites,
                  Ghosts<Dim>& ghosts) {
  std::vector<Point<Dim>> places;
  for (int i = 0; i < cloud.size(); ++i) {
    const std::span<const BoundaryMark<Dim>> marks = cloud.marks_of(i);
    if (marks.empty() || lies_on_planes_only<Dim>(marks, planes)) continue;
    if (!has_flux_condition(problem, marks)) continue;
    ghosts.of_node[i] = ghosts.size();
    ghosts.owners.push_back(i);
    const Point<Dim> place =
        cloud.nodes.col(i) + ghosts.spacing[i] * outward(problem, marks, planes);
    places.push_back(place);
  }
  const int nodes = cloud.size();
  const int all = nodes + ghosts.size();
  sites.nodes.conservativeResize(Eigen::NoChange, all);
  ghosts.spacing.conservativeResize(all);
  for (int g = 0; g < ghosts.size(); ++g) {
    sites.nodes.col(nodes + g) = places[g];
    ghosts.spacing[nodes + g] = ghosts.spacing[ghosts.owners[g]];
  }
  sites.block.reset();
  const Points<Dim> added = sites.nodes.rightCols(ghosts.size());
  if (added.cols() == 0) return;
  const Stencils near = make_search<Dim>("auto", sites.nodes)->nearest(added, 2, Ties::cut);
  for (int g = 0; g < ghosts.size(); ++g) {
    for (int j : near[g]) {
      if (j == nodes + g) continue;
      if ((sites.nodes.col(j) - places[g]).norm() > too_close * ghosts.spacing[nodes + g]) continue;
      throw CaseError(fmt::format(
          "the ghost of node {} at {} falls onto another node at {}: use another form (flux, "
          "collocation[boundary=combined]) or finer nodes there",
          cloud.number_of(ghosts.owners[g]), format_point(cloud.nodes.col(ghosts.owners[g])),
          format_point(places[g])));
    }
  }
}

#define STRONGPOINT_GHOSTS(D)                                                          \
  template Ghosts<D> prepared_ghosts(const PointCloud<D>&, const NeighbourSearch<D>&); \
  template void place_ghosts(const FluxProblem<D>&, const PointCloud<D>&,              \
                             const std::vector<SymmetryPlane>&, Sites<D>&, Ghosts<D>&);
STRONGPOINT_GHOSTS(1)
STRONGPOINT_GHOSTS(2)
STRONGPOINT_GHOSTS(3)
#undef STRONGPOINT_GHOSTS

}  // namespace strongpoint
