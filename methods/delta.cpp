#include <memory>

#include "methods/core/delta_basis.hpp"
#include "methods/core/registry.hpp"

namespace strongpoint {

/// Delta basis functions on the nearest nodes: 5 in 1D, 25 in 2D, 60 in 3D. Source: Hon & Yang
/// 2009, thesis (1.37). The matrix of nodes on a line has rank M at most, so that M must not be
/// smaller than the nodes there; M = k = 8 leave it regular on ordinary clouds (conditions up to
/// about 1e6) and err least of M = 5 to 30, k = 0 to 16. No polynomial is reproduced: derivatives
/// of order q err by h^-q times an interpolation error that does not fall with the spacing h.
MethodEntry method_delta() {
  return {{"delta",
           "delta basis functions (sine series) on local stencils",
           {{"M", "8", "sines in each coordinate, 2 to 64"},
            {"k", "8", "regularising exponent, 0 to 32"}}},
          in_every_dimension<Method>(
              []<int Dim>(Dimension<Dim>, Options& options) -> std::unique_ptr<Method<Dim>> {
                using Made = LocalMethod<Dim, DeltaBasis<Dim>>;
                const int size = Dim == 1 ? 5 : Dim == 2 ? 25 : 60;
                return std::make_unique<Made>(
                    DeltaBasis<Dim>(options.integer("M", 2, 64), options.integer("k", 0, 32)),
                    typename Made::Traits{"delta", Promises{}, {}, size});
              })};
}

}  // namespace strongpoint
