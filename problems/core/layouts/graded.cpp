#include "problems/core/layout.hpp"
#include "problems/core/structured.hpp"

namespace strongpoint {

/// Registers `graded`: geometric spacings along every axis of the unit cube.
LayoutEntry layout_graded() {
  return layout_entry(
      {"graded",
       "structured, spacings in geometric progression along every axis before the domain's map",
       {{"ratio", "5", "last / first spacing of an axis"}}},
      []<int Dim>(const Domain<Dim>& domain, const Options& options, const LayoutRequest& request) {
        // Beyond a thousand either way even coarse clouds come close to coincident nodes.
        const double ratio = options.number("ratio", 1e-3, 1e3);
        return structured_cloud(domain, graded_lattice<Dim>(domain, request.level, ratio));
      });
}

}  // namespace strongpoint
