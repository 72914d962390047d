#include "problems/core/side_nodes.hpp"

#include <fmt/format.h>

#include "methods/core/error.hpp"

namespace strongpoint {
namespace {

/// Throws for the first side that `is_needed` and has no node.
template <int Dim, class IsNeeded>
void check_sides(const Domain<Dim>& domain, const PointCloud<Dim>& cloud,
                 const std::vector<SymmetryPlane>& mirrored, IsNeeded is_needed) {
  std::vector<char> has_node(domain.sides().size(), 0);
  for (const BoundaryMark<Dim>& mark : cloud.marks) {
    if (mark.side >= 0) has_node[mark.side] = 1;
  }
  for (const SymmetryPlane& plane : mirrored) has_node[plane.side] = 1;
  for (std::size_t side = 0; side < has_node.size(); ++side) {
    if (has_node[side] != 0 || !is_needed(static_cast<int>(side))) continue;
    throw CaseError(
        fmt::format("no node lies on the side '{}', whose conditions are written at nodes: put "
                    "nodes there, marked as on it",
                    domain.sides()[side]));
  }
}

}  // namespace

template <int Dim>
void check_nodes_on_all_sides(const Domain<Dim>& domain, const PointCloud<Dim>& cloud,
                              const std::vector<SymmetryPlane>& mirrored) {
  check_sides(domain, cloud, mirrored, [](int) { return true; });
}

template <int Dim>
void check_nodes_on_value_sides(const FluxProblem<Dim>& problem, const PointCloud<Dim>& cloud,
                                const std::vector<SymmetryPlane>& mirrored) {
  const int fields = static_cast<int>(problem.fields().size());
  check_sides(problem.domain(), cloud, mirrored, [&](int side) {
    for (int f = 0; f < fields; ++f) {
      if (problem.has_flux(f) && problem.known(f, side) == Known::value) return true;
    }
    return false;
  });
}

#define STRONGPOINT_SIDE_NODES(D) /* the same two for every dimension */                \
  template void check_nodes_on_all_sides(const Domain<D>&, const PointCloud<D>&,        \
                                         const std::vector<SymmetryPlane>&);            \
  template void check_nodes_on_value_sides(const FluxProblem<D>&, const PointCloud<D>&, \
                                           const std::vector<SymmetryPlane>&);
STRONGPOINT_SIDE_NODES(1)
STRONGPOINT_SIDE_NODES(2)
STRONGPOINT_SIDE_NODES(3)
#undef STRONGPOINT_SIDE_NODES

}  // namespace strongpoint
