#include "problems/core/domain.hpp"

#include <algorithm>
#include <cmath>

namespace strongpoint {

template <int Dim>
double Domain<Dim>::spacing(const Point<Dim>&, int level) const {
  return reference_length() / (level - 1);
}

template <int Dim>
std::array<int, Dim> Domain<Dim>::nodes_along(int level) const {
  std::array<int, Dim> counts;
  counts.fill(level);
  return counts;
}

template <int Dim>
std::vector<BoundaryMark<Dim>> Domain<Dim>::marks(const std::vector<int>& sides,
                                                  const Point<Dim>& x) const {
  std::vector<BoundaryMark<Dim>> result;
  result.reserve(sides.size());
  for (int side : sides) result.push_back({side, normal(side, x)});
  return result;
}

template <int Dim>
std::vector<Block<Dim>> Domain<Dim>::blocks() const {
  Block<Dim> block{[this](const Point<Dim>& unit) { return map(unit); }, {}};
  for (int face = 0; face < 2 * Dim; ++face) {
    Point<Dim> centre = Point<Dim>::Constant(0.5);
    centre[face / 2] = face % 2;
    const std::vector<int> found = sides_at(centre);
    block.sides[face] = found.empty() ? interface_side : found.front();
  }
  return {block};
}

template <int Dim>
const std::vector<std::string>& Box<Dim>::sides() const {
  static const std::vector<std::string> all{"left", "right", "bottom", "top", "back", "front"};
  static const std::vector<std::string> names(all.begin(), all.begin() + 2 * Dim);
  return names;
}

template <int Dim>
std::vector<int> Box<Dim>::sides_at(const Point<Dim>& unit) const {
  std::vector<int> found;
  for (int c = 0; c < Dim; ++c) {
    if (unit[c] == 0) found.push_back(2 * c);
    if (unit[c] == 1) found.push_back(2 * c + 1);
  }
  return found;
}

template <int Dim>
Point<Dim> Box<Dim>::normal(int side, const Point<Dim>&) const {
  return (side % 2 == 0 ? -1 : 1) * Point<Dim>::Unit(side / 2);
}

template <int Dim>
double Box<Dim>::distance(const Point<Dim>& x) const {
  const Point<Dim> beyond = (x - lengths_ / 2).cwiseAbs() - lengths_ / 2;
  const Point<Dim> outside = beyond.cwiseMax(0);
  return outside.norm() + std::min(beyond.maxCoeff(), 0.0);
}

template <int Dim>
std::vector<BoundaryPiece<Dim>> Box<Dim>::pieces() const {
  std::vector<BoundaryPiece<Dim>> result;
  for (int side = 0; side < 2 * Dim; ++side) {
    const auto map = [side,
                      lengths = lengths_](const typename BoundaryPiece<Dim>::Parameter& parameter) {
      const int fixed = side / 2;
      Point<Dim> x;
      x[fixed] = side % 2;
      int next = 0;
      for (int c = 0; c < Dim; ++c) {
        if (c != fixed) x[c] = parameter[next++];
      }
      return Point<Dim>(x.cwiseProduct(lengths));
    };
    result.push_back({side, map});
  }
  return result;
}

template <int Dim>
std::vector<Feature<Dim>> Box<Dim>::features() const {
  std::vector<Feature<Dim>> result;
  result.reserve(2 * Dim + 1);
  for (int side = 0; side < 2 * Dim; ++side) {
    const double at = side % 2 * lengths_[side / 2];
    result.push_back(
        {sides()[side], [side, at](const Point<Dim>& x) { return std::abs(x[side / 2] - at); }});
  }
  result.push_back({"corners", [lengths = lengths_](const Point<Dim>& x) {
                      return x.cwiseAbs().cwiseMin((x - lengths).cwiseAbs()).norm();
                    }});
  return result;
}

template <int Dim>
std::array<int, Dim> Box<Dim>::nodes_along(int level) const {
  std::array<int, Dim> counts;
  for (int c = 0; c < Dim; ++c) {
    const double cells = (level - 1) * lengths_[c] / lengths_[0];
    counts[c] = 1 + std::max(1, static_cast<int>(std::lround(cells)));
  }
  return counts;
}

template class Domain<1>;
template class Domain<2>;
template class Domain<3>;
template class Box<1>;
template class Box<2>;
template class Box<3>;

}  // namespace strongpoint
