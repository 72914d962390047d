#include "methods/core/weight_function.hpp"

namespace strongpoint {

/// T = 1: the plain least-squares fit of the novel MFPM. Source: thesis 3.2.
WeightEntry weight_one() {
  return {{"one", "T = 1, all nodes count alike", {}},
          [](const Options&) { return weight_of_distance([](double) { return 1.0; }); }};
}

}  // namespace strongpoint
