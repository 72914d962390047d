#include "methods/core/weight_function.hpp"

namespace strongpoint {

/// T = 1 - 6 q^2 + 8 q^3 - 3 q^4, q = r / 1.1 R. Source: Benito, Urena, Gavete 2001.
WeightEntry weight_quartic_spline() {
  return {{"quartic_spline", "T = 1 - 6q^2 + 8q^3 - 3q^4, q = r/1.1R", {}}, [](const Options&) {
            return weight_of_distance([](double rho) {
              const double q = rho / weight_support;
              const double t = 1 - q * q * (6 - q * (8 - 3 * q));
              return t * t;
            });
          }};
}

}  // namespace strongpoint
