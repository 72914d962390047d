#include "methods/core/weight_function.hpp"

namespace strongpoint {

/// T = 4/3 (1 - q)^3, up to q = 1/2 less 16/3 (1/2 - q)^3, which makes it 2/3 - 4 q^2 + 4 q^3;
/// q = r / 1.1 R.
/// Source: Benito, Urena, Gavete 2001.
WeightEntry weight_cubic_spline() {
  return {{"cubic_spline", "cubic spline T of support 1.1R", {}}, [](const Options&) {
            return weight_of_formula({.support = weight_support,
                                      .coefficients = {4.0 / 3, -4, 4, -4.0 / 3},
                                      .knot = 0.5,
                                      .by_cube = -16.0 / 3,
                                      .power = 2});
          }};
}

}  // namespace strongpoint
