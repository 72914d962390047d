#include "methods/core/weight_function.hpp"

namespace strongpoint {

/// T = 2/3 - 4 q^2 + 4 q^3 up to q = 1/2, then 4/3 (1 - q)^3, q = r / 1.1 R.
/// Source: Benito, Urena, Gavete 2001.
WeightEntry weight_cubic_spline() {
  return {{"cubic_spline", "cubic spline T of support 1.1R", {}}, [](const Options&) {
            return weight_of_distance([](double rho) {
              const double q = rho / weight_support;
              const double t =
                  q <= 0.5 ? 2.0 / 3 - 4 * q * q * (1 - q) : 4.0 / 3 * whole_power(1 - q, 3);
              return t * t;
            });
          }};
}

}  // namespace strongpoint
