#include "methods/core/picked_stencils.hpp"
#include "methods/core/registry.hpp"
#include "methods/core/spacing.hpp"

namespace strongpoint {
namespace {

template <int Dim>
class Radius final : public StencilRule<Dim> {
 public:
  Radius(double factor, int least) : factor_(factor), least_(least) {}

  Stencils select(const Sites<Dim>& sites, std::span<const int> anchors, const Method<Dim>& method,
                  const NeighbourSearch<Dim>& search) const override {
    const Points<Dim> queries = columns_of<Dim>(sites.anchors, anchors);
    const Eigen::VectorXd radii = factor_ * local_spacing<Dim>(queries, sites.nodes, search);
    Stencils inside = search.within(queries, {radii.data(), radii.data() + radii.size()});
    const int least = least_ > 0 ? least_ : method.stencil_size();
    std::vector<int> thin;  // queries with too few nodes inside
    for (int i = 0; i < inside.size(); ++i) {
      if (static_cast<int>(inside[i].size()) < least) thin.push_back(i);
    }
    if (thin.empty()) return inside;
    const Stencils near = search.nearest(columns_of<Dim>(queries, thin), least, Ties::keep);
    return replaced(inside, thin, near);
  }

 private:
  double factor_;
  int least_;  ///< 0: what the method needs
};

}  // namespace

/// All nodes within a multiple of the local spacing, and never fewer than a number of nearest ones.
/// On a grid the local spacing is exactly the grid's, at edges and corners too. Source: thesis
/// 3.3.1, supports of SPH and its kin; the factor should not end on a shell of neighbours.
RuleEntry rule_radius() {
  return {
      {"radius",
       "all nodes within a multiple of the local spacing",
       {{"factor", "2.6",
         "radius over the local spacing (distance to the Dim-th nearest other node, averaged "
         "over neighbours)"},
        {"least", "", "nodes in a stencil at least; what the method's order needs, if not given"}}},
      in_every_dimension<StencilRule>(
          []<int Dim>(Dimension<Dim>, Options& options) -> std::unique_ptr<StencilRule<Dim>> {
            const int least = options.has("least") ? options.integer("least", 1, 100000) : 0;
            return std::make_unique<Radius<Dim>>(options.number("factor", 0.1, 100), least);
          })};
}

}  // namespace strongpoint
