#include "methods/core/weight_function.hpp"

namespace strongpoint {

/// T^2 = r^-p. Source: Benito, Urena, Gavete 2001 (powers of the distance).
WeightEntry weight_power() {
  return {{"power", "T^2 = r^-p", {{"p", "4", "power of the distance in T^2, 0 to 16"}}},
          [](const Options& options) {
            const double p = options.number("p", 0, 16);
            if (p == std::floor(p)) {
              const int whole = static_cast<int>(p);
              if (whole % 2 != 0) {
                return weight_of_formula({.coefficients = {0, 1}, .power = -whole});
              }
              return weight_of_formula({.variable = WeightFormula::Variable::square,
                                        .coefficients = {0, 1},
                                        .power = -whole / 2});
            }
            return weight_of_distance([p](double rho) { return std::pow(rho, -p); });
          }};
}

}  // namespace strongpoint
