#pragma once

#include <optional>
#include <vector>

#include "problems/core/domain.hpp"

namespace strongpoint {

/// A straight line between two positions, with the domain's distance at its ends.
template <int Dim>
struct DistanceLine {
  Point<Dim> from, to;
  double distance_from, distance_to;
  double inside = 0;  ///< distances up to this one count as inside
};

/// Finds where a line crosses the boundary of a domain: parameters in [0, 1], ascending, by
/// round-off; the line changes sides at each of them. Stretches
/// that a distance with slopes of at most 1 cannot make cross are skipped; of others, pieces
/// shorter than `resolution` are taken to cross once, or not at all unless the distance peaks in
/// between. `crossings` is overwritten.
template <int Dim>
void find_crossings(const Domain<Dim>& domain, const DistanceLine<Dim>& line, double resolution,
                    std::vector<double>& crossings);

/// Finds the boundary from x along a unit vector, forwards when x is inside and backwards when it
/// is outside: the way there, of either sign, or nothing within `reach`. Distances up to `inside`
/// count as inside; `scratch` is overwritten.
template <int Dim>
std::optional<double> height_of_boundary(const Domain<Dim>& domain, const Point<Dim>& x,
                                         const Point<Dim>& up, double reach, double inside,
                                         std::vector<double>& scratch);

}  // namespace strongpoint
