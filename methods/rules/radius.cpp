#include <cmath>

#include "methods/core/registry.hpp"

namespace strongpoint {
namespace {

template <int Dim>
class Radius final : public StencilRule<Dim> {
 public:
  explicit Radius(double factor) : factor_(factor) {}

  Stencils select(const Sites<Dim>& sites, std::span<const int> anchors, const Method<Dim>&,
                  const NeighbourSearch<Dim>& search) const override {
    const Points<Dim> queries = columns_of<Dim>(sites.anchors, anchors);
    const Stencils near = search.nearest(queries, Dim + 1, Ties::cut);
    std::vector<double> radii;
    for (std::size_t i = 0; i < anchors.size(); ++i) {
      const int last = near[static_cast<int>(i)].back();
      radii.push_back(factor_ * std::sqrt(squared_distance(sites, anchors[i], last)));
    }
    return search.within(queries, radii);
  }

 private:
  double factor_;
};

}  // namespace

/// All nodes within a multiple of the local spacing, which is the distance to the Dim-th nearest
/// other node: exactly the spacing on a grid, at its edges and corners too. Source: thesis 3.3.1,
/// supports of SPH and its kin; the factor should not end on a shell of neighbours.
RuleEntry rule_radius() {
  return {{"radius",
           "all nodes within a multiple of the local spacing",
           {{"factor", "2.6",
             "radius over local spacing (distance to the Dim-th nearest other node)"}}},
          in_every_dimension<StencilRule>(
              []<int Dim>(Dimension<Dim>, Options& options) -> std::unique_ptr<StencilRule<Dim>> {
                return std::make_unique<Radius<Dim>>(options.number("factor", 0.1, 100));
              })};
}

}  // namespace strongpoint
