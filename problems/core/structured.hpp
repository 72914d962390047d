#pragma once

#include <array>
#include <vector>

#include "problems/core/domain.hpp"

namespace strongpoint {

/// Nodes of an index block in the unit cube, before a domain's map shapes them.
template <int Dim>
struct UnitLattice {
  IndexBlock<Dim> block;
  Points<Dim> nodes;  ///< (Dim, N), the last index varies fastest
};

/// Gives n coordinates from 0 to 1 whose spacings grow geometrically; `ratio` = last / first
/// spacing, 1 for equal ones. Both ends are exact.
std::vector<double> graded_axis(int n, double ratio);

/// Makes the tensor product of lists of coordinates, one an axis.
template <int Dim>
UnitLattice<Dim> tensor_lattice(const std::array<std::vector<double>, Dim>& axes);

/// Nodes along each axis of a domain's lattice of a level whose spacings along the first axis are
/// `stretch` times as long beside those along the others as they would be, with about as many nodes
/// in all; at least two along each axis. Throws SkipCase in 1D unless `stretch` is 1.
template <int Dim>
std::array<int, Dim> stretched_counts(const Domain<Dim>& domain, int level, double stretch);

/// Makes a lattice with spacings as in `graded_axis` along every axis.
template <int Dim>
UnitLattice<Dim> graded_lattice(const std::array<int, Dim>& counts, double ratio);

/// Makes the lattice of a level of a domain, with spacings as in `graded_axis` along every axis.
template <int Dim>
UnitLattice<Dim> graded_lattice(const Domain<Dim>& domain, int level, double ratio);

/// Maps a lattice into a domain. A node with a unit coordinate of exactly 0 or 1 gets the marks of
/// the sides there. Throws CaseError when the map makes nodes coincide or is not finite.
template <int Dim>
PointCloud<Dim> structured_cloud(const Domain<Dim>& domain, const UnitLattice<Dim>& lattice);

}  // namespace strongpoint
