#pragma once

#include <optional>
#include <string>

#include "problems/core/domain.hpp"
#include "problems/core/mesh_topology.hpp"

namespace strongpoint {

/// Reads the elements of a Gmsh mesh (.msh) of a dimension, the highest that it holds unless given,
/// and its physical groups of one dimension less. Throws CaseError, beginning with the path, when
/// the file cannot be read or has no such elements. Calls from several threads wait for each other.
Mesh load_mesh(const std::string& path, std::optional<int> dimension = std::nullopt);

/// Reads the nodes of a first-order Gmsh mesh (.msh) in ascending order of their tags; nodes that
/// no element of dimension Dim uses are left out. Physical groups of dimension Dim-1, named after
/// the domain's sides, become boundary marks; the normal of a side at a node is the mean of the
/// outward normals of the side's elements there, weighted by length or area. `measure` is that of
/// the elements. Throws CaseError, beginning with the path, when the file cannot be read, holds
/// other than first-order elements of the right dimension, names an unknown side or leaves part of
/// the mesh's boundary without one. Calls from several threads wait for each other.
template <int Dim>
PointCloud<Dim> read_mesh(const Domain<Dim>& domain, const std::string& path);

}  // namespace strongpoint
