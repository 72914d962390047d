#pragma once

#include "problems/core/damping.hpp"
#include "studies/support/march.hpp"

namespace strongpoint {

/// How fast noise grows in a motion without load, 1 over time, when an integrator moves it. At time
/// 0 the displacements of all unknowns that move are random, uniform in [-1, 1), by std::mt19937_64
/// with seed 1 and `uniform01`, and the velocities 0. With T the end of the steps, r1 the
/// root of the mean square of all displacements after steps from T/4 to T/2 and r2 of those from
/// 3T/4 to T, it is ln(r2 / r1) / (T/2): by the time that lies between the two windows. States that
/// grow large are scaled by powers of 2, so that the fastest growth has a figure too. No value,
/// with a reason, for less than 8 steps and for noise that dies out altogether. Throws CaseError as
/// `march` does. `earlier` steps of the case came before, for the progress.
Quantity noise_growth(const DampedMotion& motion, const Steps& steps,
                      const std::optional<Saving>& saving, CaseMonitor* monitor,
                      std::int64_t earlier = 0);

}  // namespace strongpoint
