#include <algorithm>

#include "problems/core/form.hpp"

namespace strongpoint {
namespace {

/// True when the equations at a node read the value alone, so that no stencil is needed.
template <int Dim>
bool reads_value_only(const SteadyProblem<Dim>& problem, std::span<const BoundaryMark<Dim>> marks) {
  return problem.derivatives(marks).highest_order() == 0;
}

/// Point collocation: the equation at each node, boundary conditions at boundary nodes. With a
/// method whose nodal parameters are not values, the value is a derivative like any other, and
/// every node has a stencil.
template <int Dim>
class Collocation final : public Form<Dim> {
 public:
  std::string unsupported(const SteadyProblem<Dim>&, const Method<Dim>&) const override {
    return {};
  }

  Derivatives<Dim> derivatives(const SteadyProblem<Dim>& problem, const PointCloud<Dim>& cloud,
                               const Method<Dim>& method) const override {
    Derivatives<Dim> all;
    if (!method.promises().interpolates) all.merge({MultiIndex<Dim>{}});
    for (int i = 0; i < cloud.size(); ++i) {
      for (const MultiIndex<Dim>& alpha : problem.derivatives(cloud.marks_of(i))) {
        if (order_of<Dim>(alpha) > 0 && !all.contains(alpha)) all.merge({alpha});
      }
    }
    return all;
  }

  Sites<Dim> sites(const SteadyProblem<Dim>& problem, const PointCloud<Dim>& cloud,
                   const Method<Dim>& method) const override {
    const bool values_are_known = method.promises().interpolates;
    Sites<Dim> sites = sites_at_nodes<Dim>(cloud.nodes);
    sites.block = cloud.block;
    for (int i = 0; i < cloud.size(); ++i) {
      if (cloud.is_boundary(i)) sites.anchor_zone[i] = Zone::boundary;
      if (values_are_known && reads_value_only(problem, cloud.marks_of(i))) sites.wanted[i] = 0;
    }
    return sites;
  }

  EquationList equations(const SteadyProblem<Dim>& problem, const PointCloud<Dim>& cloud,
                         const Derivatives<Dim>& derivatives) const override {
    EquationList list;
    EquationWriter<Dim> write(list, derivatives);
    for (int i = 0; i < cloud.size(); ++i) {
      write.at(i);
      problem.equations(Node<Dim>{i, cloud.nodes.col(i), cloud.marks_of(i)}, write);
    }
    return list;
  }
};

}  // namespace

/// Registers `collocation`.
FormEntry form_collocation() {
  return {
      {"collocation",
       "the equation at each node, boundary conditions at boundary nodes",
       {{"boundary", "plain", "plain: the boundary condition replaces the equation at its node"},
        {"symmetry", "rows", "rows: symmetry planes are written as boundary conditions"}}},
      in_every_dimension<Form>(
          []<int Dim>(Dimension<Dim>, Options& options) -> std::unique_ptr<Form<Dim>> {
            options.choice<int>("boundary", {{"plain", 0}});
            options.choice<int>("symmetry", {{"rows", 0}});
            return std::make_unique<Collocation<Dim>>();
          })};
}

}  // namespace strongpoint
