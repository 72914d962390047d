#pragma once

#include <array>
#include <optional>
#include <vector>

#include "problems/core/domains/mesh_domain.hpp"
#include "problems/core/elastic_case.hpp"
#include "problems/core/problem.hpp"

namespace strongpoint {

/// What a case gives on a side; where no displacement is given, the traction is.
template <int Dim>
struct SideCondition {
  std::array<std::optional<double>, Dim> displacement;
  Point<Dim> traction = Point<Dim>::Zero();
  double pressure = 0;  ///< against the outward normal, added to the traction
};

/// A case on its mesh.
template <int Dim>
struct ElasticConditions {
  std::vector<SideCondition<Dim>> sides;       ///< one per side of the domain
  std::vector<SymmetryPlane> symmetry_planes;  ///< sides with symmetry = true
  Point<Dim> force = Point<Dim>::Zero();       ///< force over volume
  std::vector<Point<Dim>> probes;              ///< places, in the order of the case's
};

/// Matches a case with the sides of its mesh. Throws CaseError, beginning with the case's path and
/// the line, for groups that the mesh has not, values of another dimension, symmetry on a side that
/// is not a plane x_i = constant with the whole mesh on one side of it, probes outside the mesh,
/// and supports that leave the body free to move.
template <int Dim>
ElasticConditions<Dim> conditions_of(const ElasticCase& elastic, const MeshDomain<Dim>& domain);

}  // namespace strongpoint
