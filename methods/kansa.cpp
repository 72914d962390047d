#include <memory>
#include <utility>

#include "methods/core/global_interpolation.hpp"
#include "methods/core/registry.hpp"

namespace strongpoint {
namespace {

std::vector<OptionDoc> options_with_degree() {
  std::vector<OptionDoc> options = radial_options("mq");
  options.push_back({"degree", "-1", "degree of the polynomials, -1 (none) to 2"});
  return options;
}

}  // namespace

/// Kansa's method: one interpolation by radial basis functions on all nodes. Source: Kansa 1990;
/// thesis 1.3.2. The shape parameter is a multiple of the mean spacing unless its length is given.
/// Rows are dense: more than 3000 nodes are refused. As c grows over the spacing, errors fall and
/// the condition rises, until neither the rows of the value at the nodes are those of the identity
/// (c about 8 spacings with mq) nor, later, smooth functions are seen (about 50), which is refused.
MethodEntry method_kansa() {
  return {{"kansa", "Kansa's method: radial basis functions on all nodes at once",
           options_with_degree()},
          in_every_dimension<Method>(
              []<int Dim>(Dimension<Dim>, Options& options) -> std::unique_ptr<Method<Dim>> {
                const int degree = options.integer("degree", -1, 2);
                return std::make_unique<GlobalInterpolation<Dim>>(
                    RadialInterpolation<Dim>(options, degree), "kansa");
              })};
}

}  // namespace strongpoint
