#include "problems/core/layout.hpp"
#include "problems/core/structured.hpp"

namespace strongpoint {

/// Registers `grid`: equidistant in the unit cube, shaped by the domain's map.
LayoutEntry layout_grid() {
  return layout_entry(
      {"grid", "structured, equidistant before the domain's map", {}},
      []<int Dim>(const Domain<Dim>& domain, const Options&, const LayoutRequest& request) {
        return structured_cloud(domain, graded_lattice<Dim>(domain, request.level, 1));
      });
}

}  // namespace strongpoint
