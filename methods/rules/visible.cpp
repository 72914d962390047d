#include <algorithm>
#include <stdexcept>

#include "methods/core/parallel_errors.hpp"
#include "methods/core/registry.hpp"

namespace strongpoint {
namespace {

template <int Dim>
class Visible final : public StencilRule<Dim> {
 public:
  explicit Visible(std::unique_ptr<StencilRule<Dim>> base) : base_(std::move(base)) {}

  Needs needs() const override { return Needs{.sight = true} | base_->needs(); }

  Stencils select(const Sites<Dim>& sites, std::span<const int> anchors, const Method<Dim>& method,
                  const NeighbourSearch<Dim>& search) const override {
    if (!sites.sees) throw std::logic_error("the rule 'visible' needs the sight of the sites");
    const Stencils base = base_->select(sites, anchors, method, search);
    std::vector<int> all(anchors.size());
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<int>(i);
    std::vector<std::vector<int>> chosen = seen_of(sites, anchors, all, base);
    std::vector<int> thin;  // positions in `anchors` whose stencils lack nodes
    for (int i : all) {
      if (chosen[i].size() < base[i].size()) thin.push_back(i);
    }
    for (int k = 2 * most_nodes(base); !thin.empty(); k *= 2) {
      k = std::min(k, sites.node_count());
      refill(sites, anchors, search, k, base, chosen, thin);
      if (k == sites.node_count()) break;
    }
    Stencils result;
    for (const std::vector<int>& nodes : chosen) result.push_back(nodes);
    return result;
  }

 private:
  std::unique_ptr<StencilRule<Dim>> base_;

  static int most_nodes(const Stencils& stencils) {
    std::size_t most = 1;
    for (int i = 0; i < stencils.size(); ++i) most = std::max(most, stencils[i].size());
    return static_cast<int>(most);
  }

  /// The nodes of candidates[j] that anchors[positions[j]] sees, in their order.
  static std::vector<std::vector<int>> seen_of(const Sites<Dim>& sites,
                                               std::span<const int> anchors,
                                               std::span<const int> positions,
                                               const Stencils& candidates) {
    std::vector<std::vector<int>> seen(positions.size());
    ParallelErrors errors;
#pragma omp parallel for schedule(dynamic, 64)
    for (std::size_t j = 0; j < positions.size(); ++j) {
      errors.guard(static_cast<std::int64_t>(j), [&] {
        const Point<Dim> from = sites.anchors.col(anchors[positions[j]]);
        for (int node : candidates[static_cast<int>(j)]) {
          if (sites.sees(from, sites.nodes.col(node))) seen[j].push_back(node);
        }
      });
    }
    errors.rethrow();
    return seen;
  }

  /// Tops thin stencils up from the k nearest nodes with the nearest that are seen; those that are
  /// full then leave `thin`.
  static void refill(const Sites<Dim>& sites, std::span<const int> anchors,
                     const NeighbourSearch<Dim>& search, int k, const Stencils& base,
                     std::vector<std::vector<int>>& chosen, std::vector<int>& thin) {
    std::vector<int> ids;
    ids.reserve(thin.size());
    for (int i : thin) ids.push_back(anchors[i]);
    const Stencils near = search.nearest(columns_of<Dim>(sites.anchors, ids), k, Ties::cut);
    const std::vector<std::vector<int>> seen = seen_of(sites, anchors, thin, near);
    std::vector<int> still_thin;
    for (std::size_t j = 0; j < thin.size(); ++j) {
      const int i = thin[j];
      std::vector<int>& nodes = chosen[i];
      for (int node : seen[j]) {
        if (nodes.size() == base[i].size()) break;
        if (std::find(nodes.begin(), nodes.end(), node) == nodes.end()) nodes.push_back(node);
      }
      sort_stencil(sites, anchors[i], nodes);
      if (nodes.size() < base[i].size()) still_thin.push_back(i);
    }
    thin = std::move(still_thin);
  }
};

}  // namespace

/// Drops the nodes of another rule's stencils that the centre does not see within the domain and
/// takes the nearest that it does see instead, as many. Source: Belytschko, Lu and Gu 1994,
/// Element-free Galerkin methods, the visibility criterion; refilling is ours.
RuleEntry rule_visible() {
  return {{"visible",
           "another rule's stencils without nodes across a boundary, refilled with seen ones",
           {{"of", "nearest", "the rule whose stencils are cleared"}}},
          in_every_dimension<StencilRule>(
              []<int Dim>(Dimension<Dim>, Options& options) -> std::unique_ptr<StencilRule<Dim>> {
                Named<StencilRule<Dim>> base = make_rule<Dim>(options.text("of"));
                options.set("of", base.spec);
                return std::make_unique<Visible<Dim>>(std::move(base.made));
              })};
}

}  // namespace strongpoint
