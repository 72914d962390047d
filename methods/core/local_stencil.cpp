#include "methods/core/local_stencil.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "methods/core/error.hpp"

namespace strongpoint {
namespace {

/// Nodes closer than this, in units of the stencil radius, are at one place.
constexpr double coincidence = 1e-10;

/// True when two nodes of a stencil sorted by distance coincide.
template <int Dim>
bool has_coincident_nodes(const LocalStencil<Dim>& stencil) {
  for (int i = 0; i < stencil.size; ++i) {
    for (int j = i + 1; j < stencil.size; ++j) {
      if (stencil.rho[j] - stencil.rho[i] > coincidence) break;
      if ((stencil.node(i) - stencil.node(j)).norm() < coincidence) return true;
    }
  }
  return false;
}

std::string explain(LocalOutcome outcome, int size, int needed) {
  switch (outcome) {
    case LocalOutcome::too_small:
      return fmt::format("has {} nodes but at least {} are needed; ask for a larger k", size,
                         needed);
    case LocalOutcome::singular:
      return fmt::format(
          "of {} nodes is degenerate (nodes on a line or another curve of the local degree); ask "
          "for a "
          "larger k or the rule grow_until",
          size);
    case LocalOutcome::flat:
      return fmt::format(
          "of {} nodes gives a matrix that is singular to working precision: the functions are too "
          "flat; ask for sharper ones (a smaller shape parameter; a larger M of delta)",
          size);
    case LocalOutcome::coincident:
      return "holds two nodes at the same place; remove one of them";
    case LocalOutcome::no_centre:
      return "has no node at its anchor, which this method needs; use a method whose value is "
             "unknown";
    case LocalOutcome::no_block:
      return fmt::format(
          "of {} nodes is no index block of at least {}; ask for the rule block with a larger "
          "width, or for a finer cloud",
          size, needed);
    case LocalOutcome::not_finite:
      return "gives weights that are not finite; check the nodes and ask for a larger k";
    case LocalOutcome::infeasible:
      return fmt::format(
          "of {} nodes allows no non-negative weights: a point lies outside their convex hull, or "
          "they are too uneven for the second moments; ask for a larger k",
          size);
    case LocalOutcome::undecided:
    case LocalOutcome::ok:
      break;
  }
  return "is fine";
}

}  // namespace

template <int Dim>
LocalOutcome LocalStencil<Dim>::gather(const Sites<Dim>& sites, std::span<const int> nodes,
                                       int anchor) {
  ids = nodes;
  block = sites.block ? &*sites.block : nullptr;
  size = static_cast<int>(nodes.size());
  z.resize(nodes.size() * Dim);
  rho.resize(nodes.size());
  const Point<Dim> origin = sites.anchors.col(anchor);
  centre = -1;
  radius = 0;
  for (int j = 0; j < size; ++j) {
    const Point<Dim> offset = sites.nodes.col(nodes[j]) - origin;
    Eigen::Map<Point<Dim>>(z.data() + static_cast<std::ptrdiff_t>(j) * Dim) = offset;
    rho[j] = offset.norm();
    radius = std::max(radius, rho[j]);
    if (nodes[j] == sites.anchor_node[anchor]) centre = j;
  }
  if (!(radius > 0)) {
    radius = 1;
    return size > 1 ? LocalOutcome::coincident : LocalOutcome::too_small;
  }
  const double inverse = 1 / radius;
  for (double& component : z) component *= inverse;
  for (double& distance : rho) distance *= inverse;
  rounding = std::numeric_limits<double>::epsilon() * (origin.cwiseAbs().maxCoeff() * inverse + 1);
  spacing = sites.spacing.size() > 0 ? sites.spacing[anchor] * inverse : 0;
  volumes.clear();
  if (sites.volumes.size() > 0) {
    const double unit = std::pow(inverse, Dim);
    for (int node : nodes) volumes.push_back(sites.volumes[node] * unit);
  }
  return has_coincident_nodes(*this) ? LocalOutcome::coincident : LocalOutcome::ok;
}

template <int Dim>
void throw_first_failure(const Sites<Dim>& sites, const Stencils& stencils,
                         std::span<const int> anchors, std::span<const LocalOutcome> outcomes,
                         std::string_view kernel, int needed) {
  const auto bad = std::find_if(outcomes.begin(), outcomes.end(),
                                [](LocalOutcome outcome) { return outcome != LocalOutcome::ok; });
  if (bad == outcomes.end()) return;
  const int anchor = anchors[bad - outcomes.begin()];
  const int node = sites.anchor_node[anchor];
  throw CaseError(
      fmt::format("{}: the stencil of {} at {} {}", kernel,
                  node < 0 ? "the point" : fmt::format("node {}", sites.number_of(node)),
                  format_point(sites.anchors.col(anchor)),
                  explain(*bad, static_cast<int>(stencils[anchor].size()), needed)));
}

template struct LocalStencil<1>;
template struct LocalStencil<2>;
template struct LocalStencil<3>;
template void throw_first_failure(const Sites<1>&, const Stencils&, std::span<const int>,
                                  std::span<const LocalOutcome>, std::string_view, int);
template void throw_first_failure(const Sites<2>&, const Stencils&, std::span<const int>,
                                  std::span<const LocalOutcome>, std::string_view, int);
template void throw_first_failure(const Sites<3>&, const Stencils&, std::span<const int>,
                                  std::span<const LocalOutcome>, std::string_view, int);

}  // namespace strongpoint
