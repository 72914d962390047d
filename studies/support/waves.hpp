#pragma once

#include <memory>

#include "problems/core/motion.hpp"
#include "problems/core/transient_problem.hpp"
#include "studies/support/run_case.hpp"

namespace strongpoint {

/// A problem of waves, discretised and condensed.
template <int Dim>
struct Waves {
  std::unique_ptr<Discretisation<Dim>> scene;
  LinearSystem system;
  std::unique_ptr<CondensedMotion> motion;
};

/// Discretises a problem of waves, which must outlive the result; the time of each stage is added
/// to `times`, that of the condensation to `solve`. Throws SkipCase and CaseError.
template <int Dim>
Waves<Dim> make_waves(const TransientProblem<Dim>& problem, const CaseKey& key,
                      const RunOptions& options, StageTimes& times);

/// The time q that a wave takes from node to node: spacing over the speed of the fastest wave on
/// structured clouds with the same spacing along all axes, 2 / sqrt(spectral radius of K)
/// elsewhere.
template <int Dim>
double node_time(const TransientProblem<Dim>& problem, const Waves<Dim>& waves,
                 double spectral_radius);

}  // namespace strongpoint
