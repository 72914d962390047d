#include "methods/core/hilbert.hpp"

#include <algorithm>
#include <bit>

namespace strongpoint {
namespace {

/// Cubes of the same kind are passed by the curve in the same way: from their corner `entry` to its
/// neighbour along axis `direction`.
template <int Dim>
struct Kinds {
  static constexpr unsigned children = 1U << Dim;
  static constexpr unsigned count = children * Dim;

  struct Child {
    std::uint8_t place;  ///< among the children of its cube, along the curve
    std::uint8_t kind;
  };
  std::array<std::array<Child, children>, count> child{};  ///< by kind and position of the child
};

template <int Dim>
constexpr unsigned rotated_left(unsigned bits, int by) {
  return (bits << by | bits >> (Dim - by)) & ((1U << Dim) - 1);
}

/// Corner at which the curve enters the child passed as number `place`, in the frame of a cube
/// passed from corner 0.
constexpr unsigned entry_corner(unsigned place) {
  if (place == 0) return 0;
  const unsigned even = (place - 1) & ~1U;
  return even ^ even >> 1;
}

/// Axis along which it passes that child.
template <int Dim>
constexpr int axis_within(unsigned place) {
  if (place == 0) return 0;
  return std::countr_one(place % 2 == 0 ? place - 1 : place) % Dim;
}

template <int Dim>
constexpr Kinds<Dim> make_kinds() {
  Kinds<Dim> kinds;
  for (unsigned kind = 0; kind < kinds.count; ++kind) {
    const unsigned entry = kind / Dim;
    const int direction = kind % Dim;
    const int turn = (direction + 1) % Dim;
    for (unsigned place = 0; place < kinds.children; ++place) {
      const unsigned gray = place ^ place >> 1;
      const unsigned position = rotated_left<Dim>(gray, turn) ^ entry;
      const unsigned next_entry = entry ^ rotated_left<Dim>(entry_corner(place), turn);
      const unsigned next_direction = (turn + axis_within<Dim>(place)) % Dim;
      kinds.child[kind][position] = {static_cast<std::uint8_t>(place),
                                     static_cast<std::uint8_t>(next_entry * Dim + next_direction)};
    }
  }
  return kinds;
}

template <int Dim>
constexpr Kinds<Dim> kinds_of_cubes = make_kinds<Dim>();

/// Several halvings at once: a table of a few kilobytes, indexed by the kind of a cube and the
/// position within it, the bits of one axis after those of the other.
template <int Dim>
struct Leaps {
  static constexpr int levels = Dim == 3 ? 3 : 4;
  static constexpr unsigned mask = (1U << levels) - 1;
  static constexpr int place_bits = levels * Dim;

  std::array<std::uint16_t, Kinds<Dim>::count << place_bits> entry{};  ///< kind, then place
};

template <int Dim>
constexpr Leaps<Dim> make_leaps() {
  Leaps<Dim> leaps;
  for (unsigned index = 0; index < leaps.entry.size(); ++index) {
    unsigned kind = index >> leaps.place_bits;
    unsigned place = 0;
    for (int level = leaps.levels - 1; level >= 0; --level) {
      unsigned position = 0;
      for (int c = 0; c < Dim; ++c) position |= (index >> (c * leaps.levels + level) & 1U) << c;
      const auto child = kinds_of_cubes<Dim>.child[kind][position];
      place = place << Dim | child.place;
      kind = child.kind;
    }
    leaps.entry[index] = static_cast<std::uint16_t>(kind << leaps.place_bits | place);
  }
  return leaps;
}

template <int Dim>
constexpr Leaps<Dim> leaps_of_cubes = make_leaps<Dim>();

/// A point and its place on the curve.
struct Placed {
  std::uint64_t place;
  int id;
};

/// Sorts by the leading bits of the places and keeps the order of equal ones, a byte at a time.
void sort_by_leading_bits(int bits, int leading, std::vector<Placed>& placed) {
  std::vector<Placed> other(placed.size());
  for (int shift = bits - leading; shift < bits; shift += 8) {
    std::array<std::size_t, 257> first{};
    for (const Placed& p : placed) ++first[(p.place >> shift & 0xFF) + 1];
    for (std::size_t b = 1; b < first.size(); ++b) first[b] += first[b - 1];
    for (const Placed& p : placed) other[first[p.place >> shift & 0xFF]++] = p;
    placed.swap(other);
  }
}

/// Sorts by place and keeps the order of equal ones. Few points share the leading bits unless the
/// cloud is strongly graded.
void sort_by_place(int bits, std::vector<Placed>& placed) {
  constexpr int leading = 24;
  sort_by_leading_bits(bits, leading, placed);
  const int rest = bits - leading;
  for (auto begin = placed.begin(); begin != placed.end();) {
    auto end = begin + 1;
    while (end != placed.end() && end->place >> rest == begin->place >> rest) ++end;
    if (end - begin > 1) {
      std::sort(begin, end, [](const Placed& a, const Placed& b) {
        return a.place != b.place ? a.place < b.place : a.id < b.id;
      });
    }
    begin = end;
  }
}

}  // namespace

template <int Dim>
std::uint64_t hilbert_place(const std::array<std::uint32_t, Dim>& cell, int levels) {
  using Table = Leaps<Dim>;
  std::uint64_t place = 0;
  unsigned kind = 0;
  int level = levels;
  while (level % Table::levels != 0) {
    --level;
    unsigned position = 0;
    for (int c = 0; c < Dim; ++c) position |= (cell[c] >> level & 1U) << c;
    const auto child = kinds_of_cubes<Dim>.child[kind][position];
    place = place << Dim | child.place;
    kind = child.kind;
  }
  while (level > 0) {
    level -= Table::levels;
    unsigned index = kind << Table::place_bits;
    for (int c = 0; c < Dim; ++c) index |= (cell[c] >> level & Table::mask) << (c * Table::levels);
    const unsigned entry = leaps_of_cubes<Dim>.entry[index];
    place = place << Table::place_bits | (entry & ((1U << Table::place_bits) - 1));
    kind = entry >> Table::place_bits;
  }
  return place;
}

template <int Dim>
std::vector<int> hilbert_order(const Points<Dim>& points) {
  const auto count = static_cast<int>(points.cols());
  std::vector<int> order(count);
  if (count == 0) return order;
  constexpr int levels = hilbert_levels<Dim>;
  constexpr double cells = static_cast<double>((std::uint64_t{1} << levels) - 1);
  const Point<Dim> low = points.rowwise().minCoeff();
  const double extent = (points.rowwise().maxCoeff() - low).maxCoeff();
  const double scale = extent > 0 ? cells / extent : 0;
  std::vector<Placed> placed(count);
#pragma omp parallel for schedule(static)
  for (int i = 0; i < count; ++i) {
    std::array<std::uint32_t, Dim> cell{};
    for (int c = 0; c < Dim; ++c) {
      const double steps = (points(c, i) - low[c]) * scale;
      cell[c] = steps > 0 ? static_cast<std::uint32_t>(std::min(steps, cells)) : 0;
    }
    placed[i] = {hilbert_place<Dim>(cell, levels), i};
  }
  sort_by_place(levels * Dim, placed);
  for (int i = 0; i < count; ++i) order[i] = placed[i].id;
  return order;
}

#define STRONGPOINT_INSTANTIATE(Dim) /* the same for each dimension */                   \
  template std::uint64_t hilbert_place<Dim>(const std::array<std::uint32_t, Dim>&, int); \
  template std::vector<int> hilbert_order(const Points<Dim>&)
STRONGPOINT_INSTANTIATE(1);
STRONGPOINT_INSTANTIATE(2);
STRONGPOINT_INSTANTIATE(3);
#undef STRONGPOINT_INSTANTIATE

}  // namespace strongpoint
