#include "problems/core/layouts/seed.hpp"
#include "problems/core/layouts/toward.hpp"
#include "problems/core/node_fill.hpp"

namespace strongpoint {

/// Registers `scattered`: quasi-uniform nodes (blue noise) with the spacing the domain wants.
LayoutEntry layout_scattered() {
  return layout_entry(
      {"scattered", "quasi-uniform nodes (blue noise) with the domain's spacing",
       with_grading_options({seed_option()})},
      []<int Dim>(const Domain<Dim>& domain, const Options& options, const LayoutRequest& request) {
        std::mt19937_64 generator(seed_of(options, request));
        const SpacingFactor<Dim> factor = grading_of<Dim>(options, domain);
        const SpacingFunction<Dim> spacing = [&](const Point<Dim>& x) {
          return domain.spacing(x, request.level) * (factor ? factor(x) : 1);
        };
        NodeSet<Dim> set = fill_boundary(domain, spacing, generator);
        fill_interior(domain, spacing, generator, set);
        return to_cloud(domain, set);
      });
}

}  // namespace strongpoint
