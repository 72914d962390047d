#pragma once

#include <functional>
#include <memory>

#include "methods/core/registry.hpp"
#include "problems/core/form.hpp"
#include "problems/core/problem.hpp"
#include "studies/support/stage_clock.hpp"
#include "studies/support/study.hpp"

namespace strongpoint {

/// From a cloud to weights: what every study walks through, stage by stage.
template <int Dim>
struct Discretisation {
  PointCloud<Dim> cloud;
  Sites<Dim> sites;
  Stencils stencils;
  Derivatives<Dim> derivatives;
  Weights weights;
  NodeUnknowns unknowns;  ///< of a steady problem
  /// Of a steady problem: writes its equations. The problem and the cloud must live.
  std::function<EquationList(const Derivatives<Dim>&)> equations;
};

/// The method and the rule of a case.
template <int Dim>
struct Choices {
  std::unique_ptr<Method<Dim>> method;
  std::unique_ptr<StencilRule<Dim>> rule;  ///< none with a method that uses every node

  explicit Choices(const CaseKey& key)
      : method(make_method<Dim>(key.method).made),
        rule(key.stencil == every_node ? nullptr : make_rule<Dim>(key.stencil).made) {}
};

/// Makes the cloud of a case.
template <int Dim>
PointCloud<Dim> make_case_cloud(const Domain<Dim>& domain, const CaseKey& key,
                                const RunOptions& options);

/// Chooses stencils on sites already made, adding to these only what the method and the rule need;
/// the time of each stage is added to `times`. Throws SkipCase when the method cannot give the
/// derivatives.
template <int Dim>
void choose_stencils(Discretisation<Dim>& scene, const Domain<Dim>& domain,
                     const Choices<Dim>& choices, const RunOptions& options,
                     const StageClock& clock, StageTimes& times);

/// Chooses stencils, as above, and computes weights.
template <int Dim>
void compute_weights(Discretisation<Dim>& scene, const Domain<Dim>& domain,
                     const Choices<Dim>& choices, const RunOptions& options,
                     const StageClock& clock, StageTimes& times);

/// How far a problem is discretised.
enum class Upto { stencils, weights };

/// Discretises a steady problem, which must outlive the result. Throws SkipCase and CaseError.
template <int Dim>
std::unique_ptr<Discretisation<Dim>> discretise(const SteadyProblem<Dim>& problem,
                                                const CaseKey& key, const RunOptions& options,
                                                StageTimes& times, Upto upto = Upto::weights);

}  // namespace strongpoint
