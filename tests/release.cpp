// What is freed before a system is solved is nothing that its measures read.
#include "studies/support/release.hpp"

#include <gtest/gtest.h>

#include "problems/core/assembly.hpp"
#include "studies/support/run_case.hpp"
#include "tests/random_weights.hpp"

namespace strongpoint {
namespace {

TEST(Release, KeepsTheWeightsOfSomeDerivatives) {
  const Weights all = random_weights(50, 7, 5);
  const std::vector<int> slots{1, 4};
  const Weights some = weights_of(all, slots);
  EXPECT_EQ(some.per_entry, 2);
  EXPECT_EQ(some.offsets, all.offsets);
  EXPECT_EQ(some.columns, all.columns);
  for (int point = 0; point < all.size(); ++point) {
    EXPECT_EQ(Eigen::MatrixXd(some.row(point)), all.row(point)(slots, Eigen::all)) << point;
  }
}

TEST(Release, KeepsThePatternWithoutDerivatives) {
  const Weights all = random_weights(20, 7, 5);
  const Weights none = weights_of(all, {});
  EXPECT_EQ(none.columns, all.columns);
  EXPECT_TRUE(none.values.empty());
}

/// Stresses read first derivatives, and unknowns of mls are no values.
TEST(Release, LeavesWhatIsMeasuredTheSame) {
  for (const char* name : {"plate_hole", "poisson_square"}) {
    for (const char* method : {"lsfdm", "mls"}) {
      const CaseKey key{name, method, "nearest", "grid", "collocation", "umfpack", 15};
      with_problem<SteadyProblem>(name, "steady", [&]<int Dim>(const SteadyProblem<Dim>& problem) {
        StageTimes times;
        const auto scene = discretise<Dim>(problem, key, RunOptions{}, times);
        const LinearSystem system =
            assemble(scene->equations(scene->derivatives), scene->weights, scene->unknowns,
                     static_cast<int>(problem.fields().size()));
        const Eigen::VectorXd x = solve(system, key.solver).x;
        const std::vector<double> before = problem.measure(solution_of<Dim>(*scene, x));
        const int derivatives = scene->derivatives.size();
        release_unread(problem, *scene);
        EXPECT_EQ(scene->derivatives.size(), derivatives) << "too little to be freed";
        release_unread(problem, *scene, 0);
        EXPECT_LT(scene->derivatives.size(), derivatives);
        EXPECT_EQ(scene->weights.per_entry, scene->derivatives.size());
        EXPECT_EQ(problem.measure(solution_of<Dim>(*scene, x)), before) << name << " " << method;
      });
    }
  }
}

/// No problem reads more than it says.
TEST(Release, LeavesWhatEveryProblemMeasures) {
  int checked = 0;
  for (const ProblemEntry& entry : problems()) {
    if (entry.info.name == "elastic") continue;  // needs a file; measures as other elastic problems
    if (!is_kind<SteadyProblem>(entry.info.name)) continue;
    with_problem<SteadyProblem>(
        entry.info.name, "steady", [&]<int Dim>(const SteadyProblem<Dim>& problem) {
          const CaseKey key{
              entry.info.name, "lsfdm",   "grow_until",     Dim == 1 ? "grid" : "scattered",
              "collocation",   "umfpack", Dim == 3 ? 6 : 11};
          StageTimes times;
          const auto scene = discretise<Dim>(problem, key, RunOptions{}, times);
          const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(
              scene->unknowns.count * static_cast<Eigen::Index>(problem.fields().size()), -1, 2);
          const std::vector<double> before = problem.measure(solution_of<Dim>(*scene, x));
          release_unread(problem, *scene, 0);
          EXPECT_EQ(problem.measure(solution_of<Dim>(*scene, x)), before) << entry.info.name;
          ++checked;
        });
  }
  EXPECT_GT(checked, 5);
}

}  // namespace
}  // namespace strongpoint
