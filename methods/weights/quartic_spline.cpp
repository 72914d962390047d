#include "methods/core/weight_function.hpp"

namespace strongpoint {

/// T = 1 - 6 q^2 + 8 q^3 - 3 q^4, q = r / 1.1 R. Source: Benito, Urena, Gavete 2001.
WeightEntry weight_quartic_spline() {
  return {{"quartic_spline", "T = 1 - 6q^2 + 8q^3 - 3q^4, q = r/1.1R", {}}, [](const Options&) {
            return weight_of_formula(
                {.support = weight_support, .coefficients = {1, 0, -6, 8, -3}, .power = 2});
          }};
}

}  // namespace strongpoint
