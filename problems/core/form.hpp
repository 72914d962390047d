#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "methods/core/method.hpp"
#include "methods/core/options.hpp"
#include "methods/core/registry.hpp"
#include "problems/core/equation.hpp"
#include "problems/core/flux_problem.hpp"
#include "problems/core/unknowns.hpp"

namespace strongpoint {

/// The discrete system of one problem on one cloud, before weights are known.
template <int Dim>
struct Plan {
  Derivatives<Dim> derivatives;  ///< whose weights the equations read, over all points
  Sites<Dim> sites;              ///< without what the method's needs add; the first nodes and the
                                 ///< first points are the cloud's nodes, in their order
  NodeUnknowns unknowns;
  /// Writes the equations with weights for these derivatives: row = unknown node * fields + field,
  /// and any number of further rows when the system is solved by least squares. The problem and the
  /// cloud must outlive it.
  std::function<EquationList(const Derivatives<Dim>&)> equations;
};

/// How the discrete system is written: where equations are put, and which sites that takes.
template <int Dim>
class Form {
 public:
  Form() = default;
  Form(const Form&) = delete;
  Form& operator=(const Form&) = delete;
  virtual ~Form() = default;

  /// Why this problem cannot be written so, or this method cannot serve, in a sentence; empty when
  /// both can.
  virtual std::string unsupported(const SteadyProblem<Dim>& problem,
                                  const Method<Dim>& method) const = 0;
  /// True when clouds of several parts are served: what holds on interfaces is then written.
  virtual bool joins_parts() const { return false; }
  /// Lays out the discrete system of a problem that is supported. Throws SkipCase and CaseError.
  virtual Plan<Dim> plan(const SteadyProblem<Dim>& problem, const PointCloud<Dim>& cloud,
                         const Method<Dim>& method) const = 0;
};

/// The flux problem that a steady problem is, or null.
template <int Dim>
const FluxProblem<Dim>* flux_problem(const SteadyProblem<Dim>& problem) {
  return dynamic_cast<const FluxProblem<Dim>*>(&problem);
}

/// Name of the first field of a problem that has no flux; empty when all have one.
template <int Dim>
std::string field_without_flux(const SteadyProblem<Dim>& problem) {
  const FluxProblem<Dim>* balance = flux_problem(problem);
  const std::vector<std::string> fields = problem.fields();
  for (std::size_t f = 0; f < fields.size(); ++f) {
    if (balance == nullptr || !balance->has_flux(static_cast<int>(f))) return fields[f];
  }
  return {};
}

/// A registered form.
struct FormEntry {
  EntryInfo info;
  Factory<Form> factory;
};

/// All registered forms, in the order of forms.def.
const std::vector<FormEntry>& forms();

/// Canonical form of a `--form` spec. Throws UsageError when it is malformed or unknown.
std::string canonical_form(std::string_view spec);

/// Makes a form from its spec. Throws UsageError for unknown names, options and values.
template <int Dim>
std::unique_ptr<Form<Dim>> make_form(std::string_view spec);

}  // namespace strongpoint
