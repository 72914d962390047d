#include "methods/core/weight_function.hpp"

namespace strongpoint {

/// T = r^-3. Source: Benito, Urena, Gavete 2001 use powers of the distance; the thesis states none.
WeightEntry weight_inverse_cube() {
  return {{"inverse_cube", "T = r^-3", {}}, [](const Options&) {
            return weight_of_formula(
                {.variable = WeightFormula::Variable::square, .coefficients = {0, 1}, .power = -3});
          }};
}

}  // namespace strongpoint
