#include "methods/core/weight_function.hpp"

namespace strongpoint {

/// T = r^-3. Source: Benito, Urena, Gavete 2001 use powers of the distance; the thesis states none.
WeightEntry weight_inverse_cube() {
  return {{"inverse_cube", "T = r^-3", {}}, [](const Options&) {
            return weight_of_distance([](double rho) { return 1 / whole_power(rho, 6); });
          }};
}

}  // namespace strongpoint
