#pragma once

#include <vector>

#include "problems/core/elasticity.hpp"
#include "problems/core/flux_problem.hpp"
#include "problems/core/jet.hpp"
#include "problems/core/norms.hpp"

namespace strongpoint {

/// Which condition the side x = 1 carries; all others are Dirichlet.
enum class RightSide { dirichlet, neumann };

/// lap u = f on the unit cube, with f and the boundary data derived from a given u, generic in its
/// number type: `Exact{}(const std::array<T, Dim>&)`.
template <int Dim, class Exact>
class ManufacturedPoisson final : public FluxProblem<Dim> {
 public:
  explicit ManufacturedPoisson(RightSide right) : right_(right) {}

  const Domain<Dim>& domain() const override { return domain_; }
  std::vector<std::string> fields() const override { return {"u"}; }

  Derivatives<Dim> derivatives(std::span<const BoundaryMark<Dim>> marks) const override {
    if (marks.empty()) return laplacian_;
    return is_neumann(marks) ? Derivatives<Dim>{partial<Dim>(0)} : Derivatives<Dim>{};
  }

  void governing(const Place<Dim>& place, EquationWriter<Dim>& write) const override {
    for (const MultiIndex<Dim>& alpha : laplacian_) write.add(0, alpha, 1);
    write.equals(source(0, place));
  }
  void boundary(const Node<Dim>& node, EquationWriter<Dim>& write) const override {
    if (is_neumann(node.marks)) {
      write.add(0, partial<Dim>(0), 1);
      write.equals(given(0, right_side, node.x));
    } else {
      write.add(0, MultiIndex<Dim>{}, 1);
      write.equals(value_at(node.x));
    }
  }

  void flux(int, const Place<Dim>&, const Point<Dim>& direction,
            EquationWriter<Dim>& write) const override {
    for (int c = 0; c < Dim; ++c) write.add(0, partial<Dim>(c), direction[c]);
  }
  bool has_even_flux() const override { return true; }
  double source(int, const Place<Dim>& place) const override {
    return exact_derivatives<Dim>(Exact{}, place.x, laplacian_).sum();
  }
  Known known(int, int side) const override {
    const bool is_flux = right_ == RightSide::neumann && side == right_side;
    return is_flux ? Known::flux : Known::value;
  }
  double given(int field, int side, const Point<Dim>& x) const override {
    if (known(field, side) == Known::value) return value_at(x);
    return exact_derivatives<Dim>(Exact{}, x, Derivatives<Dim>{partial<Dim>(0)})[0];
  }

  std::vector<std::string> quantities() const override { return {"u_error", "u_max_error"}; }
  std::vector<double> measure(const Solution<Dim>& solution) const override {
    const Eigen::VectorXd exact = exact_at(solution.cloud.nodes);
    const Eigen::VectorXd computed = solution.fields.row(0);
    return {relative_error(computed, exact), relative_max_error(computed, exact)};
  }
  std::vector<NodeArray> derived_fields(const Solution<Dim>& solution) const override {
    return {error_array("u", solution.fields, exact_at(solution.cloud.nodes).transpose())};
  }

 private:
  static constexpr int right_side = 1;  // UnitCube's second side, x = 1
  RightSide right_;
  UnitCube<Dim> domain_;
  Derivatives<Dim> laplacian_ = [] {
    Derivatives<Dim> all;
    for (int c = 0; c < Dim; ++c) all.merge({partial<Dim>(c, c)});
    return all;
  }();

  /// Dirichlet wins at shared edges and corners.
  bool is_neumann(std::span<const BoundaryMark<Dim>> marks) const {
    return right_ == RightSide::neumann && marks.size() == 1 && marks[0].side == right_side;
  }
  /// (N) exact values.
  static Eigen::VectorXd exact_at(const Points<Dim>& nodes) {
    Eigen::VectorXd exact(nodes.cols());
    for (Eigen::Index i = 0; i < nodes.cols(); ++i) exact[i] = value_at(nodes.col(i));
    return exact;
  }
  static double value_at(const Point<Dim>& x) {
    return exact_derivatives<Dim>(Exact{}, x, Derivatives<Dim>{MultiIndex<Dim>{}})[0];
  }
};

/// The documented option and the maker shared by the square and the cube.
template <int Dim, class Exact>
ProblemEntry manufactured_poisson(std::string name, std::string summary) {
  return {{std::move(name),
           std::move(summary),
           {{"bc", "dirichlet", "dirichlet | mixed: mixed has a Neumann condition on x = 1"}}},
          [](const Options& options) -> AnyProblem {
            return std::make_unique<ManufacturedPoisson<Dim, Exact>>(options.choice<RightSide>(
                "bc", {{"dirichlet", RightSide::dirichlet}, {"mixed", RightSide::neumann}}));
          }};
}

}  // namespace strongpoint
