#include <numeric>

#include <fmt/format.h>

#include "methods/core/error.hpp"
#include "methods/core/registry.hpp"

namespace strongpoint {
namespace {

/// When a stencil is good enough, and how far it may grow.
struct Limits {
  double cond_max;
  Scaling scaling;
  ConditionNorm norm;
  int cap;
};

template <int Dim>
class GrowUntil final : public StencilRule<Dim> {
 public:
  GrowUntil(Limits limits, std::unique_ptr<StencilRule<Dim>> base)
      : limits_(limits), base_(std::move(base)) {}

  Needs needs() const override { return base_->needs(); }

  Stencils select(const Sites<Dim>& sites, std::span<const int> anchors, const Method<Dim>& method,
                  const NeighbourSearch<Dim>& search) const override {
    Stencils base = base_->select(sites, anchors, method, search);
    std::vector<int> bad(anchors.size());  // positions in `anchors` still to be judged
    std::iota(bad.begin(), bad.end(), 0);
    bad = still_bad(sites, method, anchors, base, bad);
    if (bad.empty()) return base;
    std::vector<int> ids;
    std::vector<int> grown_of(anchors.size(), -1);  // place among those found bad at first
    std::vector<std::vector<int>> grown;
    for (int i : bad) {
      grown_of[i] = static_cast<int>(ids.size());
      ids.push_back(anchors[i]);
      grown.emplace_back(base[i].begin(), base[i].end());
    }
    const Stencils near =
        search.nearest(columns_of<Dim>(sites.anchors, ids), limits_.cap, Ties::keep);
    while (!bad.empty()) {
      std::erase_if(bad, [&](int i) {
        return !grow(sites, anchors[i], near[grown_of[i]], grown[grown_of[i]]);
      });
      Stencils judged;
      ids.clear();
      for (int i : bad) {
        judged.push_back(grown[grown_of[i]]);
        ids.push_back(anchors[i]);
      }
      bad = still_bad(sites, method, ids, judged, bad);
    }
    Stencils result;
    result.offsets.reserve(anchors.size() + 1);
    result.nodes.reserve(base.nodes.size() + base.nodes.size() / 8);
    for (int i = 0; i < base.size(); ++i) {
      result.push_back(grown_of[i] < 0 ? base[i] : std::span<const int>(grown[grown_of[i]]));
    }
    return result;
  }

 private:
  Limits limits_;
  std::unique_ptr<StencilRule<Dim>> base_;

  /// Those of some positions whose stencils are worse than the limit; stencil i is of position i.
  std::vector<int> still_bad(const Sites<Dim>& sites, const Method<Dim>& method,
                             std::span<const int> anchors, const Stencils& stencils,
                             const std::vector<int>& positions) const {
    const std::vector<std::uint8_t> exceeds = method.exceeds_condition(
        sites, anchors, stencils, limits_.scaling, limits_.norm, limits_.cond_max);
    std::vector<int> bad;
    for (std::size_t i = 0; i < positions.size(); ++i) {
      if (exceeds[i] != 0) bad.push_back(positions[i]);
    }
    return bad;
  }

  /// Adds the nearest node not yet in the stencil, with its ties; false when the cap is reached.
  bool grow(const Sites<Dim>& sites, int anchor, std::span<const int> near,
            std::vector<int>& nodes) const {
    double bound = -1;
    const std::size_t before = nodes.size();
    for (int node : near) {
      const double squared = squared_distance(sites, anchor, node);
      if (bound >= 0 && squared > bound) break;
      if (std::find(nodes.begin(), nodes.begin() + static_cast<std::ptrdiff_t>(before), node) !=
          nodes.begin() + static_cast<std::ptrdiff_t>(before)) {
        continue;
      }
      if (bound < 0) bound = squared * (1 + 2 * tie_tolerance);
      nodes.push_back(node);
    }
    sort_stencil(sites, anchor, nodes);
    return nodes.size() > before && static_cast<int>(nodes.size()) <= limits_.cap;
  }
};

}  // namespace

/// Grows the stencils of another rule, nearest node by nearest node, until their local matrices are
/// well conditioned. Source: thesis 3.2.1 and 3.4, whose own limit is scaling=row, cond_max=4e8;
/// scaling both sides makes the limit independent of the spacing.
RuleEntry rule_grow_until() {
  return {
      {"grow_until",
       "another rule's stencils, grown until the local matrix is well conditioned",
       {{"cond_max", "1e3", "largest condition accepted"},
        {"scaling", "both", "both | row: sides of the local matrix scaled by the stencil radius"},
        {"norm", "two", "two | one: norm of the condition"},
        {"cap", "60", "largest stencil tried"},
        {"of", "nearest", "the rule whose stencils are grown"}}},
      in_every_dimension<StencilRule>(
          []<int Dim>(Dimension<Dim>, Options& options) -> std::unique_ptr<StencilRule<Dim>> {
            Named<StencilRule<Dim>> base = make_rule<Dim>(options.text("of"));
            options.set("of", base.spec);
            const Limits limits{
                options.number("cond_max", 1, 1e300),
                options.choice<Scaling>("scaling",
                                        {{"both", Scaling::both}, {"row", Scaling::row}}),
                options.choice<ConditionNorm>(
                    "norm", {{"two", ConditionNorm::two}, {"one", ConditionNorm::one}}),
                options.integer("cap", 2, 100000)};
            return std::make_unique<GrowUntil<Dim>>(limits, std::move(base.made));
          })};
}

}  // namespace strongpoint
