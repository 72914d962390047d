#pragma once

#include <array>
#include <string>
#include <vector>

#include "methods/core/taylor_fit.hpp"
#include "problems/core/point_cloud.hpp"

namespace strongpoint {

/// The two variants of the thesis' construction of operators.
enum class PhaseAlgorithm {
  sort,  ///< all nodes sorted by distance for every centre; condition by a 1-norm estimate
  cells  ///< candidates from cells; condition by singular values in the 2-norm
};

/// Names of the phases, in the order they are run.
inline constexpr std::array<const char*, 8> phase_names{"search",    "selection",    "matrix",
                                                        "scaling",   "condition",    "growth",
                                                        "inversion", "operator_rows"};

/// What an instrumented run gives.
struct PhaseRun {
  std::array<double, phase_names.size()> seconds{};
  Stencils stencils;  ///< one per node
  Weights weights;    ///< all derivatives of the fit, at every node
};

/// Builds the operators of a Taylor fit phase by phase, unfused, as the thesis does, and times each
/// phase. Nothing else runs this way. `volumes` is empty unless the fit's weight uses them.
/// Source: thesis 3.4, tables 3.2-3.5; the stencil grows while cond(S A) exceeds 4e8 (row scaling).
template <int Dim>
PhaseRun run_phases(const PointCloud<Dim>& cloud, const Eigen::VectorXd& volumes,
                    const TaylorFit<Dim>& fit, int stencil_size, PhaseAlgorithm algorithm);

}  // namespace strongpoint
