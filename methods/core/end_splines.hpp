#pragma once

#include <array>

namespace strongpoint {

/// The first two cubic B-splines of a knot vector that is open at xi = 0, at one point, each with
/// its first and second derivative. N_1 belongs to the node at the end, N_2 to the next, at h,
/// which is its Greville abscissa; the rest of the partition of unity, 1 - N_1 - N_2, vanishes at
/// the end like xi^2. Source: de Boor 1978 (divided differences of truncated powers); the choice of
/// knots after Rosolen & Arroyo 2013, who take those of the geometry.
struct EndSplines {
  /// Knots 0, 0, 0, 0, 3 h and `width` > 3 h, where N_2 ends; xi >= 0.
  EndSplines(double xi, double h, double width);

  std::array<double, 3> first;   ///< N_1, N_1', N_1''
  std::array<double, 3> second;  ///< N_2, N_2', N_2''
  /// Mean position of the rest of the B-splines where it begins, at xi = 0.
  double rest_at_end;
};

/// Where N_2 ends: 4 h on equidistant nodes, and far enough that the rest of the B-splines sits at
/// least a third of the widest gap beyond the third node, at `third`.
double end_spline_width(double h, double third, double widest);

}  // namespace strongpoint
