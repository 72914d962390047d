#pragma once

#include <algorithm>
#include <cmath>

namespace strongpoint {

/// Nodes that a stencil on a grid takes to hold the principal lattice of a degree at a flat
/// boundary: the half-ball of radius `degree` spacings, up to the first node at that distance. With
/// fewer, all nodes lie on `degree` planes, on whose product the local polynomial vanishes.
template <int Dim>
int boundary_lattice_size(int degree) {
  int count = 1;
  const int last = degree;
  const int from_y = Dim > 1 ? -last : 0;
  const int from_z = Dim > 2 ? -last : 0;
  for (int x = 0; x <= last; ++x) {
    for (int y = from_y; y <= -from_y; ++y) {
      for (int z = from_z; z <= -from_z; ++z) {
        if (x * x + y * y + z * z < degree * degree) ++count;
      }
    }
  }
  return count;
}

/// Nodes per Taylor coefficient (the constant included) by which a fit's default stencil is sized.
struct StencilSurplus {
  double in_1d, in_2d, in_3d;
};

/// Nodes in the default stencil of a fit: the surplus times its coefficients, but never too few for
/// a flat boundary of a grid.
template <int Dim>
int default_stencil_size(int coefficients, const StencilSurplus& surplus, int degree) {
  const double factor = Dim == 1 ? surplus.in_1d : Dim == 2 ? surplus.in_2d : surplus.in_3d;
  return std::max(static_cast<int>(std::ceil(factor * coefficients - 1e-9)),
                  boundary_lattice_size<Dim>(degree));
}

}  // namespace strongpoint
