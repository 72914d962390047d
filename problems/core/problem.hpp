#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "methods/core/derivatives.hpp"
#include "methods/core/options.hpp"
#include "methods/core/weights.hpp"
#include "problems/core/domain.hpp"
#include "problems/core/equation.hpp"

namespace strongpoint {

/// A node as a problem sees it when it states its equations.
template <int Dim>
struct Node {
  int id;
  Point<Dim> x;
  std::span<const BoundaryMark<Dim>> marks;  ///< empty inside

  bool on(int side) const {
    for (const BoundaryMark<Dim>& mark : marks) {
      if (mark.side == side) return true;
    }
    return false;
  }
};

/// What every problem has: a domain.
template <int Dim>
class Problem {
 public:
  Problem() = default;
  Problem(const Problem&) = delete;
  Problem& operator=(const Problem&) = delete;
  virtual ~Problem() = default;

  virtual const Domain<Dim>& domain() const = 0;
};

/// A computed solution with what is needed to judge it.
template <int Dim>
struct Solution {
  const PointCloud<Dim>& cloud;
  Eigen::MatrixXd fields;               ///< (fields, N) values at the nodes
  Eigen::MatrixXd parameters;           ///< (fields, N) what the weights multiply: the values, with
                                        ///< a method that interpolates
  const Weights& weights;               ///< (points x nodes), the nodes' own points first
  const Derivatives<Dim>& derivatives;  ///< of the weights

  /// A derivative of a field at every node, (N). Throws std::logic_error when it was not declared
  /// and CaseError when a node has no weights.
  Eigen::VectorXd derivative(int field, const MultiIndex<Dim>& alpha) const;
};

/// Equations per node for a set of fields, solved once.
template <int Dim>
class SteadyProblem : public Problem<Dim> {
 public:
  /// Names of the unknown fields.
  virtual std::vector<std::string> fields() const = 0;
  /// Derivatives that the equations at a node with these boundary marks read. The value alone means
  /// that no stencil is needed with a method that interpolates.
  virtual Derivatives<Dim> derivatives(std::span<const BoundaryMark<Dim>> marks) const = 0;
  /// Writes one equation per field for a node.
  virtual void equations(const Node<Dim>& node, EquationWriter<Dim>& write) const = 0;
  /// Derivatives that `measure` reads at every node, beside those of the equations.
  virtual Derivatives<Dim> measured_derivatives() const { return {}; }
  /// Names of what `measure` gives.
  virtual std::vector<std::string> quantities() const = 0;
  /// Judges a solution; one number per quantity, dimensionless unless the name says otherwise.
  virtual std::vector<double> measure(const Solution<Dim>& solution) const = 0;
};

/// A smooth function on a domain, for judging derivative weights without solving anything.
template <int Dim>
class FieldProblem : public Problem<Dim> {
 public:
  /// The derivatives judged.
  virtual Derivatives<Dim> derivatives() const = 0;
  /// Exact derivatives of the function at x, in the order of `wanted`.
  virtual Eigen::VectorXd exact(const Point<Dim>& x, const Derivatives<Dim>& wanted) const = 0;
};

/// A problem in the dimension it lives in.
using AnyProblem = std::variant<std::unique_ptr<Problem<1>>, std::unique_ptr<Problem<2>>,
                                std::unique_ptr<Problem<3>>>;

/// A registered problem.
struct ProblemEntry {
  EntryInfo info;
  AnyProblem (*make)(const Options& options);
};

/// All registered problems, in the order of problems.def.
const std::vector<ProblemEntry>& problems();

/// A problem with its canonical spec.
struct NamedProblem {
  std::string spec;
  AnyProblem made;
};

/// Makes a problem from its spec. Throws UsageError for unknown names, options and values.
NamedProblem make_problem(std::string_view spec);

}  // namespace strongpoint
