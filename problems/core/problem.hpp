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
#include "problems/core/node_array.hpp"

namespace strongpoint {

/// A position, and the patch of the domain whose data hold there: patches share positions along
/// their interfaces.
template <int Dim>
struct Place {
  Point<Dim> x;
  int patch = 0;
  double spacing = 0;  ///< of the cloud, for data that are differences; 0 where there is none
};

/// A node as a problem sees it when it states its boundary conditions.
template <int Dim>
struct Node {
  int id;
  Point<Dim> x;
  std::span<const BoundaryMark<Dim>> marks;  ///< empty inside
  int patch = 0;
  double spacing = 0;  ///< of the cloud

  Place<Dim> place() const { return {x, patch, spacing}; }

  bool on(int side) const {
    for (const BoundaryMark<Dim>& mark : marks) {
      if (mark.side == side) return true;
    }
    return false;
  }
};

/// A node of a cloud, whose spacing is given by who asks for many.
template <int Dim>
Node<Dim> node_of(const PointCloud<Dim>& cloud, int id, double spacing) {
  return {id, cloud.nodes.col(id), cloud.marks_of(id), cloud.patch_of(id), spacing};
}

/// A node of a cloud.
template <int Dim>
Node<Dim> node_of(const PointCloud<Dim>& cloud, int id) {
  return node_of(cloud, id, cloud.spacing());
}

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
  Eigen::MatrixXd parameters;           ///< (fields, nodes of the sites) what the weights multiply:
                                        ///< the values, with a method that interpolates
  const Weights& weights;               ///< (points x nodes), the nodes' own points first
  const Derivatives<Dim>& derivatives;  ///< of the weights

  /// A derivative of a field at every node, (N). Throws std::logic_error when it was not declared
  /// and CaseError when a node has no weights.
  Eigen::VectorXd derivative(int field, const MultiIndex<Dim>& alpha) const;
};

/// A flat part of the boundary across which the solution continues as its mirror image: vectors
/// with their component along the axis reversed, scalars as they are.
struct SymmetryPlane {
  int side;
  int axis;       ///< the plane is x_axis = offset
  double offset;  ///< unit of length
};

/// Equations for a set of fields, solved once.
template <int Dim>
class SteadyProblem : public Problem<Dim> {
 public:
  /// Names of the unknown fields.
  virtual std::vector<std::string> fields() const = 0;
  /// Derivatives that the equations at a node with these boundary marks read. The value alone means
  /// that no stencil is needed with a method that interpolates.
  virtual Derivatives<Dim> derivatives(std::span<const BoundaryMark<Dim>> marks) const = 0;
  /// Writes the differential equations at a place, one per field.
  virtual void governing(const Place<Dim>& place, EquationWriter<Dim>& write) const = 0;
  /// Writes what replaces them at a boundary node, one equation per field; where the value of a
  /// field is given, in that field's place.
  virtual void boundary(const Node<Dim>& node, EquationWriter<Dim>& write) const = 0;
  /// Writes the equations of a ghost node, which stands outside of a boundary node, one per field.
  /// Fields whose boundary condition is not written at the node have it here.
  virtual void ghost(const Node<Dim>& node, EquationWriter<Dim>& write) const {
    boundary(node, write);
  }
  /// Writes the equations of a node: those at the boundary where it lies on it.
  void equations(const Node<Dim>& node, EquationWriter<Dim>& write) const {
    if (node.marks.empty()) {
      governing(node.place(), write);
    } else {
      boundary(node, write);
    }
  }
  /// The axis along which a field is a component of a vector, -1 for a scalar.
  virtual int vector_axis(int) const { return -1; }
  /// Symmetry planes among the sides.
  virtual std::vector<SymmetryPlane> symmetry_planes() const { return {}; }
  /// Derivatives that `measure` reads at every node, beside those of the equations.
  virtual Derivatives<Dim> measured_derivatives() const { return {}; }
  /// Names of what `measure` gives.
  virtual std::vector<std::string> quantities() const = 0;
  /// Judges a solution; one number per quantity, dimensionless unless the name says otherwise.
  virtual std::vector<double> measure(const Solution<Dim>& solution) const = 0;
  /// What is worth looking at beside the fields, node by node: errors where the exact solution is
  /// known, stresses and the like from the weights of `measured_derivatives`. Asked for only when
  /// it is written.
  virtual std::vector<NodeArray> derived_fields(const Solution<Dim>&) const { return {}; }
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
