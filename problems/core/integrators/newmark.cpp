#include "problems/core/integrators/alpha_step.hpp"

namespace strongpoint {

/// Newmark's method. With gamma = 1/2 and beta = 1/4 (mean acceleration) it is of second order,
/// stable at any step and keeps the energy; beta = 0 is explicit without damping and gives the
/// displacements of central differences. Source: Newmark 1959.
IntegratorEntry integrator_newmark() {
  return {{"newmark",
           "Newmark, implicit, second order, keeps the energy",
           {{"beta", "0.25", "share of the new acceleration in the displacement, 0 to 0.5"},
            {"gamma", "0.5", "share of the new acceleration in the velocity, 0.5 to 1"}}},
          [](const Options& options, const Integration& integration) {
            return make_alpha_integrator(
                "newmark",
                {.beta = options.number("beta", 0, 0.5), .gamma = options.number("gamma", 0.5, 1)},
                integration);
          },
          false};
}

}  // namespace strongpoint
