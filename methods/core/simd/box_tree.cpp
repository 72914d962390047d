#include "methods/core/box_tree.hpp"

#include "methods/core/simd/pack.hpp"

namespace strongpoint::STRONGPOINT_SIMD_PATH {
namespace {

/// One bit for each of the `fan` boxes from `first` on that comes near.
template <int Dim>
unsigned near_boxes(const BoxesNear& task, int level, int first) {
  const Pack bound = all(task.reach * task.reach * (1 + 1e-9));
  unsigned bits = 0;
  for (int i = 0; i < BoxTree::fan; i += lanes) {
    Pack square = all(0);
    for (int c = 0; c < Dim; ++c) {
      const Pack below = load(task.tree->low[level][c] + first + i) - all(task.high[c]);
      const Pack above = all(task.low[c]) - load(task.tree->high[level][c] + first + i);
      const Pack gap = max(max(below, above), all(0));
      square = square + gap * gap;
    }
    bits |= less(square, bound) << i;
  }
  return bits;
}

template <int Dim>
void list_near(const BoxesNear& task) {
  int first[BoxTree::most_levels];
  unsigned bits[BoxTree::most_levels];
  int level = task.tree->levels - 1;
  int count = 0;
  first[level] = 0;
  bits[level] = near_boxes<Dim>(task, level, 0);
  while (true) {
    if (bits[level] == 0) {
      if (++level == task.tree->levels) break;
      continue;
    }
    const int box = first[level] + __builtin_ctz(bits[level]);
    bits[level] &= bits[level] - 1;
    --level;
    first[level] = box * BoxTree::fan;
    bits[level] = near_boxes<Dim>(task, level, first[level]);
    if (level > 0) continue;
    for (; bits[0] != 0; bits[0] &= bits[0] - 1) {
      task.found[count++] = first[0] + __builtin_ctz(bits[0]);
    }
    ++level;
  }
  *task.count = count;
}

}  // namespace

void list_boxes_near(const BoxesNear& task) {
  if (task.dim == 2) list_near<2>(task);
  if (task.dim == 3) list_near<3>(task);
}

}  // namespace strongpoint::STRONGPOINT_SIMD_PATH
