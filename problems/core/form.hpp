#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "methods/core/method.hpp"
#include "methods/core/options.hpp"
#include "methods/core/registry.hpp"
#include "problems/core/equation.hpp"
#include "problems/core/problem.hpp"

namespace strongpoint {

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
  /// Derivatives whose weights the equations read, over all nodes that need a stencil.
  virtual Derivatives<Dim> derivatives(const SteadyProblem<Dim>& problem,
                                       const PointCloud<Dim>& cloud,
                                       const Method<Dim>& method) const = 0;
  /// The sites the problem needs on this cloud, without what the method's needs add. The first
  /// points are the nodes, in their order.
  virtual Sites<Dim> sites(const SteadyProblem<Dim>& problem, const PointCloud<Dim>& cloud,
                           const Method<Dim>& method) const = 0;
  /// One row per node and field, row = node * fields + field.
  virtual EquationList equations(const SteadyProblem<Dim>& problem, const PointCloud<Dim>& cloud,
                                 const Derivatives<Dim>& derivatives) const = 0;
};

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
