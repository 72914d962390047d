#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "methods/core/error.hpp"
#include "methods/core/picked_stencils.hpp"
#include "methods/core/registry.hpp"

namespace strongpoint {
namespace {

/// What becomes of a block at an edge of the cloud.
enum class Ends {
  shift,  ///< it is moved inwards
  shrink  ///< it keeps the centre in the middle as long as it has enough nodes
};

template <int Dim>
class Block final : public StencilRule<Dim> {
 public:
  Block(int width, Ends ends) : width_(width), ends_(ends) {}

  Stencils select(const Sites<Dim>& sites, std::span<const int> anchors, const Method<Dim>& method,
                  const NeighbourSearch<Dim>&) const override {
    if (!sites.block) {
      throw SkipCase(
          "the rule 'block' needs a structured cloud (grid, perturbed, graded, blocks) to which "
          "the "
          "form adds no nodes (ghosts, mirror images)");
    }
    // An odd width keeps the centre in the middle: 3 for order 2, 5 for orders 3 and 4.
    const int order = std::max(1, method.promises().reproduces);
    const int least = 2 * ((order + 1) / 2) + 1;
    const int width = width_ > 0 ? width_ : least;
    const int at_edges = ends_ == Ends::shift ? width : std::min(width, least);
    return pick_stencils(anchors.size(), [&] {
      return [&](std::size_t i, std::vector<int>& nodes) {
        append_block(sites, anchors[i], width, at_edges, nodes);
      };
    });
  }

 private:
  int width_;  ///< 0: what the method's order needs
  Ends ends_;

  static void append_block(const Sites<Dim>& sites, int anchor, int width, int at_edges,
                           std::vector<int>& nodes) {
    const auto& shape = sites.block->shape;
    int node = sites.anchor_node[anchor];
    if (node < 0) throw SkipCase("the rule 'block' needs anchors that are nodes");
    std::array<int, Dim> first{};
    std::array<int, Dim> count{};
    std::size_t size = 1;
    for (int c = Dim - 1; c >= 0; --c) {
      const int index = node % shape[c];
      node /= shape[c];
      const int centred = 2 * std::min(index, shape[c] - 1 - index) + 1;
      count[c] = std::min({width, std::max(centred, at_edges), shape[c]});
      first[c] = std::clamp(index - count[c] / 2, 0, shape[c] - count[c]);
      size *= count[c];
    }
    const std::size_t before = nodes.size();
    for (std::size_t j = 0; j < size; ++j) {
      int id = 0;
      std::size_t left = j;
      std::size_t lines = size;
      for (int c = 0; c < Dim; ++c) {
        lines /= count[c];
        id = id * shape[c] + first[c] + static_cast<int>(left / lines);
        left %= lines;
      }
      nodes.push_back(id);
    }
    sort_stencil(sites, anchor, std::span(nodes).subspan(before));
  }
};

}  // namespace

/// Index block of a structured cloud around the centre, shifted inwards at the edges: the thesis'
/// searching algorithm 3. With `ends=shrink`, wide blocks give up width there to stay centred, down
/// to what the method's order needs; one-sided wide blocks make waves grow. Source: thesis 6.3.3;
/// `shrink` is ours.
RuleEntry rule_block() {
  return {
      {"block",
       "index block of a structured cloud, shifted inwards at the edges",
       {{"width", "", "nodes along each axis; the method's order plus one, made odd, if not given"},
        {"ends", "shift", "shift | shrink: wide blocks move inwards at edges, or lose width"}}},
      in_every_dimension<StencilRule>(
          []<int Dim>(Dimension<Dim>, Options& options) -> std::unique_ptr<StencilRule<Dim>> {
            const int width = options.has("width") ? options.integer("width", 2, 101) : 0;
            const auto ends =
                options.choice<Ends>("ends", {{"shift", Ends::shift}, {"shrink", Ends::shrink}});
            return std::make_unique<Block<Dim>>(width, ends);
          })};
}

}  // namespace strongpoint
