#include "problems/core/layouts/stretch.hpp"

namespace strongpoint {

/// Registers `grid`: equidistant in the unit cube, shaped by the domain's map.
LayoutEntry layout_grid() {
  return layout_entry(
      {"grid", "structured, equidistant before the domain's map", {stretch_option()}},
      []<int Dim>(const Domain<Dim>& domain, const Options& options, const LayoutRequest& request) {
        return structured_cloud(domain, stretched_lattice<Dim>(domain, options, request));
      });
}

}  // namespace strongpoint
