#include "problems/core/layouts/seed.hpp"
#include "problems/core/layouts/stretch.hpp"
#include "problems/core/random.hpp"

namespace strongpoint {
namespace {

/// What happens to nodes on the boundary.
enum class BoundaryNodes {
  fixed,  ///< they stay
  slide   ///< they move along their edge or face, corners stay
};

/// Moves every coordinate that is free by U(-amount, amount) of the spacing. Random numbers are
/// drawn for nodes in ascending order and for all coordinates of a node, used or not, so that
/// interior nodes do not depend on what boundary nodes do.
template <int Dim>
void perturb(const Domain<Dim>& domain, double amount, BoundaryNodes boundary,
             std::mt19937_64& generator, UnitLattice<Dim>& lattice) {
  Points<Dim>& unit = lattice.nodes;
  for (Eigen::Index i = 0; i < unit.cols(); ++i) {
    const Point<Dim> before = unit.col(i);
    const Eigen::Array<bool, Dim, 1> on_face = before.array() == 0 || before.array() == 1;
    for (int c = 0; c < Dim; ++c) {
      const double reach = amount / (lattice.block.shape[c] - 1);
      const double shift = reach * (2 * uniform01(generator) - 1);
      const bool is_free = boundary == BoundaryNodes::slide ? !on_face[c] : !on_face.any();
      if (is_free) unit(c, i) += shift;
    }
    // A corner of the domain may lie inside a face of the unit cube: such a node stays as well.
    if (on_face.any() && domain.sides_at(unit.col(i)) != domain.sides_at(before)) {
      unit.col(i) = before;
    }
  }
}

}  // namespace

/// Registers `perturbed`: the grid with its nodes moved at random; it keeps its index block.
LayoutEntry layout_perturbed() {
  return layout_entry(
      {"perturbed",
       "grid with nodes moved at random before the domain's map",
       {{"amount", "0.2",
         "largest move in each coordinate, as a fraction of the spacing, 0 to 0.49"},
        seed_option(),
        stretch_option(),
        {"boundary", "fixed", "boundary nodes: fixed, or slide along their edge or face"}}},
      []<int Dim>(const Domain<Dim>& domain, const Options& options, const LayoutRequest& request) {
        // Below one half neighbours cannot meet.
        const double amount = options.number("amount", 0, 0.49);
        const BoundaryNodes boundary = options.choice<BoundaryNodes>(
            "boundary", {{"fixed", BoundaryNodes::fixed}, {"slide", BoundaryNodes::slide}});
        std::mt19937_64 generator(seed_of(options, request));
        UnitLattice<Dim> lattice = stretched_lattice<Dim>(domain, options, request);
        perturb(domain, amount, boundary, generator, lattice);
        return structured_cloud(domain, lattice);
      });
}

}  // namespace strongpoint
