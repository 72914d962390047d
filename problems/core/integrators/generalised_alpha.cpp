#include "problems/core/integrators/alpha_step.hpp"

namespace strongpoint {

/// The generalised-alpha method: second order, stable at any step; a step keeps the share rho_inf
/// of the amplitude of the fastest vibrations and nearly all of that of slow ones. Source: Chung &
/// Hulbert 1993, (17), (20), (25): alpha_m = (2 rho - 1) / (rho + 1), alpha_f = rho / (rho + 1),
/// gamma = 1/2 - alpha_m + alpha_f, beta = (1 - alpha_m + alpha_f)^2 / 4.
IntegratorEntry integrator_generalised_alpha() {
  return {{"generalised_alpha",
           "generalised alpha, implicit, second order, damps what is not resolved",
           {{"rho_inf", "0.5", "share of the fastest vibrations that a step keeps, 0 to 1"}}},
          [](const Options& options, const Integration& integration) {
            const double rho = options.number("rho_inf", 0, 1);
            const double alpha_m = (2 * rho - 1) / (rho + 1);
            const double alpha_f = rho / (rho + 1);
            const double shift = alpha_f - alpha_m;
            return make_alpha_integrator("generalised_alpha",
                                         {.beta = (1 + shift) * (1 + shift) / 4,
                                          .gamma = 0.5 + shift,
                                          .inertia = alpha_m,
                                          .displacement = alpha_f},
                                         integration);
          },
          false};
}

}  // namespace strongpoint
