#pragma once

#include <memory>
#include <string>
#include <vector>

#include "problems/core/solvers.hpp"
#include "studies/support/discretise.hpp"

namespace strongpoint {

/// The fields at the nodes from the values of all unknowns; refers to the scene.
template <int Dim>
Solution<Dim> solution_of(const Discretisation<Dim>& scene, const Eigen::VectorXd& unknowns);

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
