#pragma once

#include <string>
#include <vector>

#include "studies/support/dispersion_options.hpp"

namespace strongpoint {

/// Names of what a case gives, row by row. Throws SkipCase when the problem is of another kind.
std::vector<std::string> dispersion_quantities(const CaseKey& key,
                                               const DispersionOptions& options);

/// What the symbols at the chosen nodes make of waves, for each wavenumber, direction and branch:
/// `phase_velocity` and `group_velocity` (along the wave) over the exact speed, and `dissipation`,
/// the imaginary part of omega over the exact omega, negative where the wave grows (its reverse
/// then decays); for each direction and branch `points_per_wavelength`, down to which the phase
/// velocity errs by 1 % at most, and over the directions `points_per_wavelength_worst` and `_best`;
/// over all wave vectors with |xi_c| h at most pi, sampled on a lattice, `symbol_growth`, the
/// largest |Im omega| in exact time, 1 over time, `symbol_radius`, the largest |eigenvalue|
/// (h/c)^2, and `stable_courant`, the step over h/c up to which central differences are stable if
/// all eigenvalues are real, c being the fastest speed. On irregular clouds these are figures of
/// single nodes, not of the system: what grows by one node's symbol may decay by the next one's.
/// Throws SkipCase and CaseError.
CaseResult run_dispersion_case(const CaseKey& key, const RunOptions& options,
                               const DispersionOptions& dispersion);

}  // namespace strongpoint
