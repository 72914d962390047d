#include "problems/core/domains/octant_pieces.hpp"

namespace strongpoint {

std::vector<BoundaryPiece<3>> octant_pieces(const Point<3>& corner, const RadialSurface& inner,
                                            const RadialSurface& outer, const OctantSides& sides) {
  using Parameter = BoundaryPiece<3>::Parameter;
  std::vector<BoundaryPiece<3>> result;
  for (int c = 0; c < 3; ++c) {
    const int d = (c + 1) % 3;
    const int e = (c + 2) % 3;
    const auto on_box = [corner, c, d, e](const Parameter& t) {
      Point<3> q;
      q[c] = corner[c];
      q[d] = t[0] * corner[d];
      q[e] = t[1] * corner[e];
      return q;
    };
    result.push_back({sides.inner, [=](const Parameter& t) { return inner(on_box(t)); }});
    result.push_back({sides.outer[c], [=](const Parameter& t) { return outer(on_box(t)); }});
    for (const auto& [fixed, along] : {std::array{d, e}, std::array{e, d}}) {
      const auto on_edge = [corner, fixed = fixed, along = along](double t) {
        Point<3> q = Point<3>::Zero();
        q[fixed] = corner[fixed];
        q[along] = t * corner[along];
        return q;
      };
      result.push_back({sides.planes[c], [=](const Parameter& t) -> Point<3> {
                          const Point<3> q = on_edge(t[0]);
                          return (1 - t[1]) * inner(q) + t[1] * outer(q);
                        }});
    }
  }
  return result;
}

}  // namespace strongpoint
