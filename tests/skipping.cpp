// Nothing that a scene does not need is computed; nothing that was not declared can be read.
#include <gtest/gtest.h>

#include "problems/core/layout.hpp"
#include "problems/core/transient_problem.hpp"
#include "studies/support/run_case.hpp"

namespace strongpoint {
namespace {

template <int Dim>
Discretisation<Dim> discretised(const std::string& problem, const std::string& method) {
  const CaseKey key{problem,
                    method,
                    make_method<Dim>(method).made->default_stencil(),
                    "perturbed",
                    "collocation",
                    "umfpack",
                    9};
  StageTimes times;
  return with_problem<SteadyProblem>(
      problem, "steady", [&]<int D>(const SteadyProblem<D>& steady) -> Discretisation<Dim> {
        if constexpr (D == Dim) return std::move(*discretise<D>(steady, key, RunOptions{}, times));
        throw std::logic_error("the problem lives in another dimension");
      });
}

/// True when a method can stand in a problem of second order in 2D.
bool gives_second_derivatives(const std::string& method) {
  return make_method<2>(method).made->unsupported(Derivatives<2>::between_orders(1, 2)).empty();
}

TEST(Skipping, DirichletNodesHaveNoStencilWithMethodsThatInterpolate) {
  for (const MethodEntry& entry : methods()) {
    const Promises promises = make_method<2>(entry.info.name).made->promises();
    if (!gives_second_derivatives(entry.info.name)) continue;
    const auto scene = discretised<2>("poisson_square", entry.info.name);
    if (!promises.interpolates) {
      EXPECT_TRUE(scene.derivatives.contains({0, 0})) << entry.info.name;
      continue;
    }
    for (int i = 0; i < scene.cloud.size(); ++i) {
      if (promises.local) {
        EXPECT_EQ(scene.stencils[i].empty(), scene.cloud.is_boundary(i)) << entry.info.name;
      }
      EXPECT_EQ(scene.weights.nodes(i).empty(), scene.cloud.is_boundary(i)) << entry.info.name;
    }
  }
  const auto mixed = discretised<2>("poisson_square[bc=mixed]", "lsfdm");
  int with_stencil = 0;
  for (int i = 0; i < mixed.cloud.size(); ++i) {
    with_stencil += mixed.cloud.is_boundary(i) && !mixed.stencils[i].empty() ? 1 : 0;
  }
  EXPECT_EQ(with_stencil, 7);  // x = 1 without its two Dirichlet corners
}

TEST(Skipping, PoissonHoldsNoMixedDerivative) {
  const auto square = discretised<2>("poisson_square", "lsfdm");
  EXPECT_EQ(square.weights.per_entry, 2);
  EXPECT_EQ(square.derivatives, (Derivatives<2>{{2, 0}, {0, 2}}));
  EXPECT_THROW(square.derivatives.index({1, 1}), std::logic_error);
  const auto cube = discretised<3>("poisson_cube", "lsfdm");
  EXPECT_EQ(cube.weights.per_entry, 3);
}

TEST(Skipping, VolumesAreMadeForMethodsThatIntegrateOnly) {
  for (const MethodEntry& entry : methods()) {
    if (!gives_second_derivatives(entry.info.name)) continue;
    const auto scene = discretised<2>("plate_hole", entry.info.name);
    const Needs needs = make_method<2>(entry.info.name).made->needs();
    EXPECT_EQ(scene.sites.volumes.size() > 0, needs.volumes) << entry.info.name;
    EXPECT_EQ(scene.sites.spacing.size() > 0, needs.spacing) << entry.info.name;
  }
}

/// Drops each declared derivative in turn and expects the equations to notice, those in space of a
/// problem in time.
void check_that_dropping_throws(const std::string& spec) {
  const auto check = []<int D>(const SteadyProblem<D>& problem) {
    const PointCloud<D> cloud = make_cloud<D>(problem.domain(), "scattered", LayoutRequest{7, 1});
    const auto form = make_form<D>("collocation");
    const auto method = make_method<D>("lsfdm").made;
    const Plan<D> plan = form->plan(problem, cloud, *method);
    const Derivatives<D>& declared = plan.derivatives;
    EXPECT_NO_THROW(plan.equations(declared));
    for (const MultiIndex<D>& alpha : declared) {
      EXPECT_THROW(plan.equations(declared.without(alpha)), std::logic_error) << name_of<D>(alpha);
    }
  };
  if (is_kind<TransientProblem>(spec)) {
    with_problem<TransientProblem>(spec, "transient",
                                   [&](const auto& problem) { check(problem.space()); });
  } else {
    with_problem<SteadyProblem>(spec, "steady", check);
  }
}

TEST(Skipping, ReadingADerivativeThatWasNotDeclaredThrows) {
  for (const ProblemEntry& entry : problems()) {
    if (entry.info.name == "field" || entry.info.name == "elastic") continue;  // needs a file
    check_that_dropping_throws(entry.info.name);
  }
}

}  // namespace
}  // namespace strongpoint
