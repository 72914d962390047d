#pragma once

#include <memory>
#include <string>
#include <vector>

#include "methods/core/registry.hpp"
#include "problems/core/form.hpp"
#include "problems/core/problem.hpp"
#include "problems/core/solvers.hpp"
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

/// The fields at the nodes from the values of all unknowns; refers to the scene.
template <int Dim>
Solution<Dim> solution_of(const Discretisation<Dim>& scene, const Eigen::VectorXd& unknowns);

/// Makes the cloud of a case.
template <int Dim>
PointCloud<Dim> make_case_cloud(const Domain<Dim>& domain, const CaseKey& key,
                                const RunOptions& options);

/// Names of what a steady case measures. Throws SkipCase when the problem is of another kind.
std::vector<std::string> steady_quantities(const CaseKey& key);

/// Solves a steady problem once: the system's size, times and what the problem measures. Throws
/// SkipCase and CaseError.
template <int Dim>
CaseResult solve_steady(const SteadyProblem<Dim>& problem, const CaseKey& key,
                        const RunOptions& options);

/// Runs a steady case from cloud to measured quantities; the times are minima over `repeat` runs.
/// With `options.vtk` the fields at the nodes are written.
/// Throws SkipCase and CaseError.
CaseResult run_steady_case(const CaseKey& key, const RunOptions& options);

/// True when a problem is of a kind, as `with_problem` takes it.
template <template <int> class Kind>
bool is_kind(const std::string& spec) {
  return std::visit(
      []<int Dim>(const std::unique_ptr<Problem<Dim>>& problem) {
        return dynamic_cast<const Kind<Dim>*>(problem.get()) != nullptr;
      },
      make_problem(spec).made);
}

/// Calls `function(problem)` with the problem of a spec as `Kind<Dim>`, or throws SkipCase saying
/// that the study wants a `kind` problem.
template <template <int> class Kind, class Function>
auto with_problem(const std::string& spec, const std::string& kind, Function&& function) {
  const NamedProblem named = make_problem(spec);
  return std::visit(
      [&]<int Dim>(const std::unique_ptr<Problem<Dim>>& problem) {
        const auto* wanted = dynamic_cast<const Kind<Dim>*>(problem.get());
        if (wanted == nullptr) {
          throw SkipCase(spec + " is not a " + kind + " problem, which this study runs");
        }
        return function(*wanted);
      },
      named.made);
}

/// Keeps the smaller of two times of each stage, and the larger peak of memory.
StageTimes fastest(const StageTimes& a, const StageTimes& b);

}  // namespace strongpoint
