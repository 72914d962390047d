#include "methods/core/weight_function.hpp"

namespace strongpoint {

/// T^2 = (1 - (r / 1.1 R)^2)^4, R the largest distance. Source: Ding, Shu, Yeo, Xu 2004.
WeightEntry weight_bump4() {
  return {{"bump4", "T^2 = (1 - (r/1.1R)^2)^4, R the stencil radius", {}}, [](const Options&) {
            return weight_of_formula({.variable = WeightFormula::Variable::square,
                                      .support = weight_support,
                                      .coefficients = {1, -1},
                                      .power = 4});
          }};
}

}  // namespace strongpoint
