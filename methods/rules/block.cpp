#include <algorithm>

#include "methods/core/error.hpp"
#include "methods/core/registry.hpp"

namespace strongpoint {
namespace {

template <int Dim>
class Block final : public StencilRule<Dim> {
 public:
  explicit Block(int width) : width_(width) {}

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
    const int width = width_ > 0 ? width_ : 2 * ((order + 1) / 2) + 1;
    Stencils result;
    for (int anchor : anchors) result.push_back(block_at(sites, anchor, width));
    return result;
  }

 private:
  int width_;  ///< 0: what the method's order needs

  static std::vector<int> block_at(const Sites<Dim>& sites, int anchor, int width) {
    const auto& shape = sites.block->shape;
    int node = sites.anchor_node[anchor];
    if (node < 0) throw SkipCase("the rule 'block' needs anchors that are nodes");
    std::array<int, Dim> first{};
    std::array<int, Dim> count{};
    for (int c = Dim - 1; c >= 0; --c) {
      const int index = node % shape[c];
      node /= shape[c];
      count[c] = std::min(width, shape[c]);
      first[c] = std::clamp(index - width / 2, 0, shape[c] - count[c]);
    }
    std::vector<int> nodes{0};
    for (int c = 0; c < Dim; ++c) {
      std::vector<int> next;
      for (int base : nodes) {
        for (int i = 0; i < count[c]; ++i) next.push_back(base * shape[c] + first[c] + i);
      }
      nodes = std::move(next);
    }
    sort_stencil(sites, anchor, nodes);
    return nodes;
  }
};

}  // namespace

/// Index block of a structured cloud around the centre, shifted inwards at the edges: the thesis'
/// searching algorithm 3. Source: thesis 6.3.3.
RuleEntry rule_block() {
  return {{"block",
           "index block of a structured cloud, shifted inwards at the edges",
           {{"width", "",
             "nodes along each axis; the method's order plus one, made odd, if not given"}}},
          in_every_dimension<StencilRule>(
              []<int Dim>(Dimension<Dim>, Options& options) -> std::unique_ptr<StencilRule<Dim>> {
                const int width = options.has("width") ? options.integer("width", 2, 101) : 0;
                return std::make_unique<Block<Dim>>(width);
              })};
}

}  // namespace strongpoint
