#include <algorithm>
#include <array>

#include "methods/core/registry.hpp"

namespace strongpoint {
namespace {

/// Sector (half-line, quadrant, octant) of an offset. A zero component takes the sign of the
/// component before it (cyclically in three), or the opposite sign of the one after it when that is
/// zero too, so that every half-axis belongs to a sector of its own; in 2D the sectors are
/// [x>0,y>=0], [x<=0,y>0], [x<0,y<=0], [x>=0,y<0].
template <int Dim>
int sector_of(const Point<Dim>& offset) {
  std::array<double, 3> x{};
  for (int c = 0; c < Dim; ++c) x[c] = offset[c];
  int sector = 0;
  for (int c = 0; c < Dim; ++c) {
    const double before = x[(c + 2) % 3];
    const double after = x[(c + 1) % 3];
    const double sign = x[c] != 0 ? x[c] : before != 0 ? before : -after;
    sector += (sign > 0 ? 1 : 0) << c;
  }
  return sector;
}

template <int Dim>
class Star final : public StencilRule<Dim> {
 public:
  explicit Star(int per_sector) : per_sector_(per_sector) {}

  Stencils select(const Sites<Dim>& sites, std::span<const int> anchors, const Method<Dim>&,
                  const NeighbourSearch<Dim>& search) const override {
    constexpr int candidates_per_sector = 4;  // enough unless spacing is very uneven
    const int total = per_sector_ * (1 << Dim);
    const Stencils near =
        nearest_to_anchors(sites, anchors, candidates_per_sector * total + 1, Ties::keep, search);
    Stencils result;
    for (std::size_t i = 0; i < anchors.size(); ++i) {
      const std::span<const int> nodes = near[static_cast<int>(i)];
      result.push_back(choose(sites, anchors[i], by_rank(sites, anchors[i], nodes), total));
    }
    return result;
  }

 private:
  int per_sector_;

  /// Candidates with those at equal distances (to the tie tolerance) in the order of their ids, so
  /// that round-off does not choose among them.
  static std::vector<int> by_rank(const Sites<Dim>& sites, int anchor, std::span<const int> near) {
    std::vector<int> nodes(near.begin(), near.end());
    for (auto first = nodes.begin(); first != nodes.end();) {
      const double bound = squared_distance(sites, anchor, *first) * (1 + 2 * tie_tolerance);
      const auto last = std::find_if(first, nodes.end(), [&](int node) {
        return squared_distance(sites, anchor, node) > bound;
      });
      std::sort(first, last);
      first = last;
    }
    return nodes;
  }

  /// The nearest nodes of each sector, then the nearest unused ones while sectors lack nodes.
  std::vector<int> choose(const Sites<Dim>& sites, int anchor, const std::vector<int>& near,
                          int total) const {
    std::array<int, 8> taken{};
    std::vector<int> chosen;
    std::vector<int> unused;
    for (int node : near) {
      const Point<Dim> offset = sites.nodes.col(node) - sites.anchors.col(anchor);
      if (node == sites.anchor_node[anchor]) {
        chosen.push_back(node);
      } else if (taken[sector_of<Dim>(offset)] < per_sector_) {
        ++taken[sector_of<Dim>(offset)];
        chosen.push_back(node);
      } else {
        unused.push_back(node);
      }
    }
    const std::size_t wanted = total + (sites.anchor_node[anchor] >= 0 ? 1 : 0);
    for (std::size_t j = 0; j < unused.size() && chosen.size() < wanted; ++j) {
      chosen.push_back(unused[j]);
    }
    sort_stencil(sites, anchor, chosen);
    return chosen;
  }
};

}  // namespace

/// Star criterion: the nearest nodes of each quadrant of a frame at the centre, filled up with the
/// nearest others where a quadrant holds too few. Source: Benito et al. 2007; thesis 3.3.1.
RuleEntry rule_star() {
  return {{"star",
           "star criterion: the nearest nodes of each quadrant (half-line, octant)",
           {{"per_sector", "2", "nodes per sector, 1 to 50"}}},
          in_every_dimension<StencilRule>(
              []<int Dim>(Dimension<Dim>, Options& options) -> std::unique_ptr<StencilRule<Dim>> {
                return std::make_unique<Star<Dim>>(options.integer("per_sector", 1, 50));
              })};
}

}  // namespace strongpoint
