#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "methods/core/parallel_errors.hpp"
#include "methods/core/stencils.hpp"

namespace strongpoint {

/// Stencils made one by one, on several threads. make_picker() is called for every few hundred of
/// them and returns what appends stencil i to a list: picker(i, nodes).
template <class MakePicker>
Stencils pick_stencils(std::size_t count, MakePicker make_picker) {
  constexpr std::size_t at_once = 256;
  const std::size_t blocks = (count + at_once - 1) / at_once;
  std::vector<std::vector<int>> parts(blocks);
  Stencils made;
  made.offsets.assign(count + 1, 0);
  ParallelErrors errors;
#pragma omp parallel for schedule(dynamic)
  for (std::size_t b = 0; b < blocks; ++b) {
    errors.guard(static_cast<std::int64_t>(b), [&] {
      auto picker = make_picker();
      const std::size_t end = std::min((b + 1) * at_once, count);
      for (std::size_t i = b * at_once; i < end; ++i) {
        picker(i, parts[b]);
        made.offsets[i + 1] = static_cast<std::int64_t>(parts[b].size());
      }
    });
  }
  errors.rethrow();
  std::vector<std::int64_t> before(blocks + 1, 0);
  for (std::size_t b = 0; b < blocks; ++b) {
    before[b + 1] = before[b] + static_cast<std::int64_t>(parts[b].size());
  }
  made.nodes.resize(before[blocks]);
#pragma omp parallel for schedule(static)
  for (std::size_t b = 0; b < blocks; ++b) {
    const std::size_t end = std::min((b + 1) * at_once, count);
    for (std::size_t i = b * at_once; i < end; ++i) made.offsets[i + 1] += before[b];
    std::copy(parts[b].begin(), parts[b].end(), made.nodes.begin() + before[b]);
  }
  return made;
}

/// Stencils of which those at some places, ascending, are taken from others.
inline Stencils replaced(const Stencils& stencils, std::span<const int> places,
                         const Stencils& others) {
  Stencils made;
  made.offsets.reserve(stencils.offsets.size());
  made.nodes.reserve(stencils.nodes.size() + others.nodes.size());
  std::size_t next = 0;
  for (int i = 0; i < stencils.size(); ++i) {
    const bool is_other = next < places.size() && places[next] == i;
    made.push_back(is_other ? others[static_cast<int>(next++)] : stencils[i]);
  }
  return made;
}

}  // namespace strongpoint
