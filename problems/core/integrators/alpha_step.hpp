#pragma once

#include <memory>
#include <string_view>

#include "problems/core/integrator.hpp"

namespace strongpoint {

/// Constants of Newmark's steps with a balance between two times, dimensionless.
struct AlphaConstants {
  double beta;              ///< share of the new acceleration in the displacement
  double gamma;             ///< share of the new acceleration in the velocity
  double inertia = 0;       ///< alpha_m: weight of the old acceleration in the balance
  double displacement = 0;  ///< alpha_f: weight of the old displacement, velocity and time in it
};

/// An integrator that finds the acceleration at the end of a step from
/// (1 - alpha_m) a1 + alpha_m a0 = K w + load(t0 + (1 - alpha_f) dt) f,
/// w = (1 - alpha_f) (u1 + s v1) + alpha_f (u0 + s v0), s the time of the stiffness damping, with
/// Newmark's u1 = u0 + dt v0 + dt^2 ((1/2 - beta) a0 + beta a1) and
/// v1 = v0 + dt ((1 - gamma) a0 + gamma a1). One product and one solve a step with the factors of
/// I - c K, c = (1 - alpha_f) (beta dt^2 + s gamma dt) / (1 - alpha_m). Throws SkipCase for
/// hyperviscosity on behalf of the integrator named. Source: Chung & Hulbert 1993, section 2,
/// with K for -M^-1 K.
std::unique_ptr<Integrator> make_alpha_integrator(std::string_view name,
                                                  const AlphaConstants& constants,
                                                  const Integration& integration);

}  // namespace strongpoint
