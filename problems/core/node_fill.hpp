#pragma once

#include <random>
#include <vector>

#include "problems/core/curve_march.hpp"
#include "problems/core/domain.hpp"
#include "problems/core/point_tree.hpp"

namespace strongpoint {

/// Nodes being placed: positions and the sides each lies on, empty inside.
template <int Dim>
struct NodeSet {
  PointTree<Dim> nodes;
  std::vector<std::vector<int>> sides;
};

/// Places nodes on the boundary with a spacing: corners, then along each edge equidistant in the
/// integral of ds / h, then (3D) over each face by an advancing front. Nodes shared by pieces
/// appear once, with the sides of all of them. Throws SkipCase when the domain describes no
/// boundary and CaseError when the spacing is not positive.
template <int Dim>
NodeSet<Dim> fill_boundary(const Domain<Dim>& domain, const SpacingFunction<Dim>& spacing,
                           std::mt19937_64& generator);

/// Fills the inside from the boundary inwards until no node fits: each node proposes candidates one
/// spacing away in equispaced directions, randomly turned, and those are taken that lie inside,
/// half a spacing off the boundary, and one spacing off every node. Source: Slak and Kosec 2019, On
/// generation of node distributions for meshless PDE discretizations, algorithm 3.1, with the
/// spacing taken midway between a node and its candidate.
template <int Dim>
void fill_interior(const Domain<Dim>& domain, const SpacingFunction<Dim>& spacing,
                   std::mt19937_64& generator, NodeSet<Dim>& set);

/// Makes the cloud of a set of nodes, with the normals of the domain.
template <int Dim>
PointCloud<Dim> to_cloud(const Domain<Dim>& domain, const NodeSet<Dim>& set);

}  // namespace strongpoint
