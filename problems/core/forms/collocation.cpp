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

  Plan<Dim> plan(const SteadyProblem<Dim>& problem, const PointCloud<Dim>& cloud,
                 const Method<Dim>& method) const override {
    const bool values_are_known = method.promises().interpolates;
    const bool reads_every_node = problem.measured_derivatives().size() > 0;
    Plan<Dim> plan;
    plan.unknowns.count = cloud.size();
    plan.sites = sites_of_cloud<Dim>(cloud);
    if (!values_are_known) plan.derivatives.merge({MultiIndex<Dim>{}});
    for (int i = 0; i < cloud.size(); ++i) {
      for (const MultiIndex<Dim>& alpha : problem.derivatives(cloud.marks_of(i))) {
        if (order_of<Dim>(alpha) > 0) plan.derivatives.merge({alpha});
      }
      if (values_are_known && !reads_every_node && reads_value_only(problem, cloud.marks_of(i))) {
        plan.sites.wanted[i] = 0;
      }
    }
    plan.equations = [&problem, &cloud](const Derivatives<Dim>& derivatives) {
      EquationList list;
      EquationWriter<Dim> write(list, derivatives);
      for (int i = 0; i < cloud.size(); ++i) {
        write.at(i);
        problem.equations(node_of(cloud, i), write);
      }
      return list;
    };
    return plan;
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
