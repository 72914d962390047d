#pragma once

#include <optional>
#include <string>
#include <vector>

#include "problems/core/elastic_fields.hpp"
#include "problems/core/elasticity.hpp"
#include "problems/core/flux_problem.hpp"

namespace strongpoint {

/// The unknown fields of an elasticity problem.
enum class Unknowns {
  displacement,  ///< mu lap u + (lambda + mu) grad div u + b = 0; locks as nu approaches 0.5
  mixed          ///< also p = -lambda div u: div(2 mu eps) - grad p + b = 0, div u + p / lambda = 0
};

/// The option that chooses them, and its value.
OptionDoc unknowns_option();
Unknowns chosen_unknowns(const Options& options);
/// The same for a material with this Poisson's ratio. Throws UsageError for a pressure with a ratio
/// of 0, where lambda is 0 and the pressure none.
Unknowns chosen_unknowns(const Options& options, double poisson);

/// Static linear elasticity, stated once for all forms: a problem gives its domain, its material,
/// body forces and, side by side, which displacement or traction components are known.
///
/// Boundary nodes under collocation. A displacement component given on any side through the node
/// wins. The components left take, one side meeting the node, its traction; where faces with
/// tractions meet, the normal traction of each and, along the directions left over (an edge of a
/// solid), the sum of their shear tractions; a face that `owns_corners` gives all by itself. Faces
/// with tractions go before supports; where only supports meet, their tractions are added up, and
/// so they are when faces outnumber the components left, meet smoothly or lie across them.
template <int Dim>
class ElasticProblem : public FluxProblem<Dim> {
 public:
  explicit ElasticProblem(Unknowns unknowns = Unknowns::displacement) : unknowns_(unknowns) {}

  /// The material at a place.
  virtual Lame material(const Place<Dim>& place) const = 0;
  /// Gradients of the material, where it varies within a patch: (Dim) each, stress over length.
  virtual LameGradient<Dim> material_gradient(const Place<Dim>&) const {
    return LameGradient<Dim>{};
  }
  /// True when `material_gradient` is not zero everywhere.
  virtual bool varies() const { return false; }
  /// Body force, force over volume.
  virtual Point<Dim> body_force(const Place<Dim>&) const { return Point<Dim>::Zero(); }
  /// Field i < Dim is the displacement along axis i, its flux component i of the traction.
  Known known(int field, int side) const override = 0;
  /// True when a loaded side alone gives the tractions where it meets others.
  virtual bool owns_corners(int) const { return false; }

  bool is_mixed() const { return unknowns_ == Unknowns::mixed; }
  std::vector<std::string> fields() const override;
  int vector_axis(int field) const override { return field < Dim ? field : -1; }
  Derivatives<Dim> derivatives(std::span<const BoundaryMark<Dim>> marks) const override;
  Derivatives<Dim> flux_derivatives() const override {
    return Derivatives<Dim>::between_orders(is_mixed() ? 0 : 1, 1);
  }
  bool has_even_flux() const override { return !varies(); }
  bool has_flux(int field) const override { return field < Dim; }
  void governing(const Place<Dim>& place, EquationWriter<Dim>& write) const override;
  void boundary(const Node<Dim>& node, EquationWriter<Dim>& write) const override;
  void ghost(const Node<Dim>& node, EquationWriter<Dim>& write) const override;
  void flux(int field, const Place<Dim>& place, const Point<Dim>& direction,
            EquationWriter<Dim>& write) const override {
    add_traction_along(place, Point<Dim>::Unit(field), direction, write);
  }
  double source(int field, const Place<Dim>& place) const override {
    return field < Dim ? -body_force(place)[field] : 0;
  }
  /// `elastic_arrays`; stresses where `measured_derivatives` has all first derivatives.
  std::vector<NodeArray> derived_fields(const Solution<Dim>& solution) const override;

 protected:
  /// Stress components at the nodes, (Dim (Dim + 1) / 2, N), in the order of `stress_names`, from
  /// the solution's weights. Throws CaseError when a node has none.
  Eigen::MatrixXd nodal_stresses(const Solution<Dim>& solution) const;
  /// Exact displacements and stresses at the nodes, where they are known.
  virtual std::optional<ElasticNodes> exact_at_nodes(const PointCloud<Dim>&) const { return {}; }
  /// Relative 2-norms over all nodes of the errors of the displacements and of the stresses, where
  /// `exact_at_nodes` gives them.
  std::vector<double> errors_at_nodes(const Solution<Dim>& solution) const;
  static Derivatives<Dim> first_derivatives() { return Derivatives<Dim>::between_orders(1, 1); }

 private:
  Unknowns unknowns_;

  /// Adds m . sigma n.
  void add_traction_along(const Place<Dim>& place, const Point<Dim>& m, const Point<Dim>& n,
                          EquationWriter<Dim>& write) const;
  /// Adds the pressure of the mixed form to what is exact.
  void add_pressure(const std::vector<Lame>& materials, ElasticNodes& exact) const;
  void write_constraint(const Place<Dim>& place, EquationWriter<Dim>& write) const;
  /// The tractions of some faces along m, added up, equal the given ones.
  void write_traction(const Node<Dim>& node, std::span<const BoundaryMark<Dim>> faces,
                      const Point<Dim>& m, EquationWriter<Dim>& write) const;
  /// The sides whose tractions count at a node.
  std::vector<BoundaryMark<Dim>> loaded_faces(const Node<Dim>& node) const;
  void write_conditions(const Node<Dim>& node, EquationWriter<Dim>& write) const;
};

/// Names of the stress components: the normal ones, then shear: xx, yy, xy; in 3D xx, yy, zz, xy,
/// xz, yz.
template <int Dim>
std::vector<std::string> stress_names();

/// The components of a symmetric tensor, in the order of `stress_names`.
template <int Dim>
Eigen::Matrix<double, Dim*(Dim + 1) / 2, 1> tensor_components(
    const Eigen::Matrix<double, Dim, Dim>& tensor);

extern template class ElasticProblem<2>;
extern template class ElasticProblem<3>;

}  // namespace strongpoint
