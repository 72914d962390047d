#include "methods/core/registry.hpp"

namespace strongpoint {
namespace {

template <int Dim>
class ZonedRule final : public StencilRule<Dim> {
 public:
  ZonedRule(std::unique_ptr<StencilRule<Dim>> interior, std::unique_ptr<StencilRule<Dim>> boundary)
      : interior_(std::move(interior)), boundary_(std::move(boundary)) {}

  Needs needs() const override { return interior_->needs() | boundary_->needs(); }

  Stencils select(const Sites<Dim>& sites, std::span<const int> anchors, const Method<Dim>& method,
                  const NeighbourSearch<Dim>& search) const override {
    std::vector<int> inside;
    std::vector<int> at_boundary;
    for (int a : anchors) {
      (sites.anchor_zone[a] == Zone::interior ? inside : at_boundary).push_back(a);
    }
    const Stencils first = interior_->select(sites, inside, method.in_zone(Zone::interior), search);
    const Stencils second =
        boundary_->select(sites, at_boundary, method.in_zone(Zone::boundary), search);
    Stencils result;
    int next_inside = 0;
    int next_at_boundary = 0;
    for (int a : anchors) {
      result.push_back(sites.anchor_zone[a] == Zone::interior ? first[next_inside++]
                                                              : second[next_at_boundary++]);
    }
    return result;
  }

 private:
  std::unique_ptr<StencilRule<Dim>> interior_, boundary_;
};

}  // namespace

/// One rule inside, another at every node with a boundary mark.
/// Source: numerical experience that what is right inside is often wrong at a traction boundary.
RuleEntry rule_zoned() {
  return {{"zoned",
           "one rule inside, another at boundary nodes",
           {{"interior", "nearest", "rule at interior nodes"},
            {"boundary", "nearest", "rule at boundary nodes"}}},
          in_every_dimension<StencilRule>(
              []<int Dim>(Dimension<Dim>, Options& options) -> std::unique_ptr<StencilRule<Dim>> {
                Named<StencilRule<Dim>> interior = make_rule<Dim>(options.text("interior"));
                Named<StencilRule<Dim>> boundary = make_rule<Dim>(options.text("boundary"));
                options.set("interior", interior.spec);
                options.set("boundary", boundary.spec);
                return std::make_unique<ZonedRule<Dim>>(std::move(interior.made),
                                                        std::move(boundary.made));
              })};
}

}  // namespace strongpoint
