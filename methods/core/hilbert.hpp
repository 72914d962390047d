#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "methods/core/points.hpp"

namespace strongpoint {

/// Halvings of the cube around the points that tell their places on the curve apart.
template <int Dim>
inline constexpr int hilbert_levels = Dim == 1   ? 32
                                      : Dim == 2 ? 24
                                                 : 15;

/// Place along the Hilbert curve of a cell among the (2^levels)^Dim of a cube, from 0 on; cells of
/// consecutive places share a face. `levels` is at most `hilbert_levels`. Source: Hamilton 2006,
/// Compact Hilbert indices, Dalhousie University, algorithm 2.
template <int Dim>
std::uint64_t hilbert_place(const std::array<std::uint32_t, Dim>& cell, int levels);

/// Ids of points along a Hilbert curve through the cube around them: points near each other in the
/// list are near each other in space. Points of one of the smallest cells keep their order. Where
/// coordinates are not finite the order means nothing. The same for any number of threads; cost:
/// linear.
template <int Dim>
std::vector<int> hilbert_order(const Points<Dim>& points);

}  // namespace strongpoint
