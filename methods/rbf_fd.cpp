#include <algorithm>
#include <cmath>

#include "methods/core/polyharmonic.hpp"
#include "methods/core/registry.hpp"
#include "methods/core/stencil_size.hpp"

namespace strongpoint {

/// RBF-generated finite differences: polyharmonic splines r^phs with all polynomials up to a
/// degree. Source: Flyer, Fornberg, Bayona, Barnett 2016. The stencil has about twice as many nodes
/// as there are polynomial terms, never fewer than the terms plus a 3^Dim block, and enough for a
/// flat boundary of a grid.
MethodEntry method_rbf_fd() {
  return {
      {"rbf_fd",
       "RBF-FD: polyharmonic splines with polynomials",
       {{"phs", "3", "odd power of the distance, 1 to 11"},
        {"degree", "2", "degree of the polynomials, (phs - 1)/2 to 8"}}},
      in_every_dimension<Method>([]<int Dim>(Dimension<Dim>,
                                             Options& options) -> std::unique_ptr<Method<Dim>> {
        const int degree = options.integer("degree", 0, 8);
        PolyharmonicFit<Dim> fit(options.integer("phs", 1, 11), degree);
        const int terms = fit.terms();
        const int block = static_cast<int>(std::lround(std::pow(3, Dim)));
        const int size = std::max({2 * terms, terms + block, boundary_lattice_size<Dim>(degree)});
        using Made = LocalMethod<Dim, PolyharmonicFit<Dim>>;
        Promises promises;
        promises.reproduces = degree;
        return std::make_unique<Made>(std::move(fit),
                                      typename Made::Traits{"rbf_fd", promises, {}, size});
      })};
}

}  // namespace strongpoint
