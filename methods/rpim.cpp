#include "methods/core/radial_interpolation.hpp"
#include "methods/core/registry.hpp"

namespace strongpoint {
namespace {

std::vector<OptionDoc> options_with_degree() {
  std::vector<OptionDoc> options = radial_options("mq");
  options.push_back({"degree", "1", "degree of the polynomials, 0 to 2"});
  return options;
}

}  // namespace

/// Radial Point Interpolation Method: radial basis functions with polynomials on the nearest nodes.
/// Source: Wang & Liu 2002; thesis (1.30)-(1.36), corrected as RadialInterpolation says.
MethodEntry method_rpim() {
  return {{"rpim", "Radial Point Interpolation Method: radial functions with polynomials",
           options_with_degree()},
          in_every_dimension<Method>([]<int Dim>(Dimension<Dim>, Options& options) {
            return make_radial_method<Dim>("rpim", options, options.integer("degree", 0, 2));
          })};
}

}  // namespace strongpoint
