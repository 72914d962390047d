#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "methods/core/picked_stencils.hpp"
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

/// Chooses the nodes of one star after the other.
template <int Dim>
class StarPicker {
 public:
  StarPicker(const Sites<Dim>& sites, int per_sector) : sites_(sites), per_sector_(per_sector) {}

  /// Appends the nearest nodes of each sector, then the nearest others while sectors lack nodes.
  /// `near` is sorted by (distance, id). Returns whether no sector lacks any.
  bool pick(int anchor, std::span<const int> near, std::vector<int>& nodes) {
    const int own = sites_.anchor_node[anchor];
    const std::size_t wanted = per_sector_ * (1 << Dim) + (own >= 0 ? 1 : 0);
    std::array<int, 1 << Dim> taken{};
    chosen_.clear();
    unused_.clear();
    for (std::size_t next = 0; next < near.size() && chosen_.size() < wanted;) {
      next = take_ties(anchor, near, next);
      for (const Candidate& tie : ties_) {
        bool is_chosen = tie.node == own;
        if (!is_chosen) {
          int& of_sector =
              taken[sector_of<Dim>(sites_.nodes.col(tie.node) - sites_.anchors.col(anchor))];
          is_chosen = of_sector < per_sector_;
          if (is_chosen) ++of_sector;
        }
        (is_chosen ? chosen_ : unused_).push_back(tie);
      }
    }
    const bool is_full = chosen_.size() == wanted;
    const std::size_t lacking = std::min(wanted - chosen_.size(), unused_.size());
    chosen_.insert(chosen_.end(), unused_.begin(), unused_.begin() + static_cast<long>(lacking));
    if (!std::is_sorted(chosen_.begin(), chosen_.end())) std::sort(chosen_.begin(), chosen_.end());
    for (const Candidate& one : chosen_) nodes.push_back(one.node);
    return is_full;
  }

 private:
  const Sites<Dim>& sites_;
  const int per_sector_;
  std::vector<Candidate> ties_, chosen_, unused_;

  /// Fills `ties_` with the next node and those as far away (to the tie tolerance), in the order of
  /// their ids, so that round-off does not choose among them. Returns where the next ones begin.
  std::size_t take_ties(int anchor, std::span<const int> near, std::size_t next) {
    ties_.assign(1, {squared_distance(sites_, anchor, near[next]), near[next]});
    const double bound = ties_[0].squared_distance * (1 + 2 * tie_tolerance);
    bool is_sorted = true;
    for (++next; next < near.size(); ++next) {
      const double square = squared_distance(sites_, anchor, near[next]);
      if (square > bound) break;
      is_sorted = is_sorted && near[next] > ties_.back().node;
      ties_.push_back({square, near[next]});
    }
    if (!is_sorted) {
      std::sort(ties_.begin(), ties_.end(),
                [](const Candidate& a, const Candidate& b) { return a.node < b.node; });
    }
    return next;
  }
};

template <int Dim>
class Star final : public StencilRule<Dim> {
 public:
  explicit Star(int per_sector) : per_sector_(per_sector) {}

  Stencils select(const Sites<Dim>& sites, std::span<const int> anchors, const Method<Dim>&,
                  const NeighbourSearch<Dim>& search) const override {
    std::vector<std::uint8_t> full;
    Stencils stars = among(2, sites, anchors, search, full);
    std::vector<int> open;  // places in `anchors` of those whose sectors reach farther, if at all
    std::vector<int> ids;
    for (std::size_t i = 0; i < anchors.size(); ++i) {
      if (full[i] != 0) continue;
      open.push_back(static_cast<int>(i));
      ids.push_back(anchors[i]);
    }
    if (open.empty()) return stars;
    std::vector<std::uint8_t> filled;
    return replaced(stars, open, among(4, sites, ids, search, filled));
  }

 private:
  int per_sector_;

  /// The stars of anchors, looked for among so many nodes a node that is wanted; fills whether
  /// their sectors are full. Four are enough unless spacing is very uneven.
  Stencils among(int candidates, const Sites<Dim>& sites, std::span<const int> anchors,
                 const NeighbourSearch<Dim>& search, std::vector<std::uint8_t>& full) const {
    const int count = candidates * per_sector_ * (1 << Dim) + 1;
    const Stencils near = nearest_to_anchors(sites, anchors, count, Ties::keep, search);
    full.assign(anchors.size(), 0);
    return pick_stencils(anchors.size(), [&] {
      return [&, picker = StarPicker<Dim>(sites, per_sector_)](std::size_t i,
                                                               std::vector<int>& nodes) mutable {
        full[i] = picker.pick(anchors[i], near[static_cast<int>(i)], nodes) ? 1 : 0;
      };
    });
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
