#include "problems/core/blocks.hpp"

#include <charconv>

#include "methods/core/error.hpp"
#include "problems/core/layout.hpp"

namespace strongpoint {
namespace {

constexpr int most_cells = 100;

/// The cells along each axis: "2" or, one number an axis, "1x2".
template <int Dim>
std::array<int, Dim> split_of(const Options& options) {
  const std::string& text = options.text("split");
  const char* at = text.data();
  const char* end = at + text.size();
  std::vector<int> cells;
  while (at < end && cells.size() < Dim) {
    int count = 0;
    const auto [next, error] = std::from_chars(at, end, count);
    if (error != std::errc{} || count < 1 || count > most_cells) break;
    cells.push_back(count);
    at = next;
    if (at + 1 < end && *at == 'x') ++at;
  }
  if (at != end || (cells.size() != 1 && cells.size() != Dim)) {
    throw UsageError(fmt::format(
        "{}={} is no split; give a number of cells from 1 to {}, or one an axis as in 1x2",
        options.where("split"), text, most_cells));
  }
  std::array<int, Dim> split;
  for (int c = 0; c < Dim; ++c) split[c] = cells.size() == 1 ? cells[0] : cells[c];
  return split;
}

}  // namespace

/// Registers `blocks`: every block of the domain with nodes of its own, joined along interfaces.
LayoutEntry layout_blocks() {
  return layout_entry(
      {"blocks",
       "structured nodes in every block of a mapped domain, doubled where blocks meet",
       {{"n", "0", "nodes a side of each block; 0: the level"},
        {"nodes", "uniform", "uniform | clustered | chebyshev | gll: along a side"},
        {"split", "1", "cells a side that each block is split into; one number an axis: 1x2"},
        {"ratio", "1",
         "of the widths of cells from the middle of a block towards its faces, 0.05 "
         "to 1"}}},
      []<int Dim>(const Domain<Dim>& domain, const Options& options, const LayoutRequest& request) {
        const int given = options.integer("n", 0, 1000);
        const auto nodes =
            options.choice<BlockNodes>("nodes", {{"uniform", BlockNodes::uniform},
                                                 {"clustered", BlockNodes::clustered},
                                                 {"chebyshev", BlockNodes::chebyshev},
                                                 {"gll", BlockNodes::gll}});
        const int n = given > 0 ? given : request.level;
        if (n < 2) {
          throw UsageError(
              fmt::format("{}={}: at least 2 nodes a side are needed", options.where("n"), n));
        }
        const double ratio = options.number("ratio", 0.05, 1);
        const std::array<int, Dim> split = split_of<Dim>(options);
        std::array<std::vector<double>, Dim> ends;
        for (int c = 0; c < Dim; ++c) ends[c] = cell_ends(split[c], ratio);
        return block_cloud<Dim>(domain, block_axis(nodes, n), ends);
      });
}

}  // namespace strongpoint
