// The data of every problem: exact solutions satisfy their equations, and agree with closed forms.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "problems/core/assembly.hpp"
#include "problems/core/form.hpp"
#include "problems/core/layout.hpp"
#include "problems/core/problem.hpp"
#include "studies/support/run_case.hpp"

namespace strongpoint {
namespace {

/// Whether a problem can be judged on a grid by an exact solution.
bool is_judged_on_grids(const std::string& problem) {
  // Known at single points only, without a grid, or exact: see elastic_problems.cpp, patches.cpp.
  const auto elsewhere = {"field",        "cook",    "block_bore",
                          "thick_sphere", "elastic", "two_materials"};
  return std::find(elsewhere.begin(), elsewhere.end(), problem) == elsewhere.end();
}

/// Errors at two levels with the second-order setting that suits traction boundaries too: a problem
/// whose data do not belong together cannot converge.
TEST(Problems, EverySteadyProblemConvergesAtSecondOrder) {
  int tried = 0;
  for (const ProblemEntry& entry : problems()) {
    if (!is_judged_on_grids(entry.info.name)) continue;
    if (!is_kind<SteadyProblem>(entry.info.name)) continue;
    const bool is_3d = make_problem(entry.info.name).made.index() == 2;
    const int coarse = is_3d ? 7 : 17;
    std::vector<double> errors;
    for (const int level : {coarse, 2 * coarse - 1}) {
      const CaseKey key{entry.info.name,
                        "zoned",
                        "zoned[interior=nearest,boundary=nearest]",
                        "grid",
                        "collocation",
                        "umfpack",
                        level};
      errors.push_back(run_steady_case(key, RunOptions{}).quantities[0].value.value());
    }
    EXPECT_LT(errors[1], errors[0] / 3.3) << entry.info.name;
    ++tried;
  }
  EXPECT_GE(tried, 6);
}

/// Kirsch's stresses by thesis (4.15), written in polar coordinates, against the traction data that
/// the problem derives from the displacements.
TEST(Problems, PlateTractionsEqualTheThesisStresses) {
  constexpr double a = 0.2;
  constexpr double tension = 100;
  with_problem<SteadyProblem>(
      "plate_hole", "steady", [&]<int Dim>(const SteadyProblem<Dim>& problem) {
        if constexpr (Dim == 2) {
          const PointCloud<2> cloud = make_cloud<2>(problem.domain(), "grid", LayoutRequest{21, 1});
          const Derivatives<2> all = Derivatives<2>::between_orders(0, 2);
          int compared = 0;
          for (int i = 0; i < cloud.size(); ++i) {
            const auto marks = cloud.marks_of(i);
            if (marks.size() != 1 || problem.domain().sides()[marks[0].side] != "right") continue;
            EquationList list;
            EquationWriter<2> write(list, all);
            problem.equations(Node<2>{i, cloud.nodes.col(i), marks}, write);
            const double r = cloud.nodes.col(i).norm();
            const double t = std::atan2(cloud.nodes(1, i), cloud.nodes(0, i));
            const double q = a * a / (r * r);
            const double xx = tension * (1 - q * (1.5 * std::cos(2 * t) + std::cos(4 * t)) +
                                         1.5 * q * q * std::cos(4 * t));
            const double xy = tension * (-q * (0.5 * std::sin(2 * t) + std::sin(4 * t)) +
                                         1.5 * q * q * std::sin(4 * t));
            ASSERT_EQ(list.size(), 2);
            EXPECT_NEAR(list.right_hand_sides[0], xx, 1e-10 * tension);
            EXPECT_NEAR(list.right_hand_sides[1], xy, 1e-10 * tension);
            ++compared;
          }
          EXPECT_GE(compared, 9);
        } else {
          FAIL() << "plate_hole is two-dimensional";
        }
      });
}

TEST(Problems, PlateNodesFollowTheDefinitions) {
  const NamedProblem plate = make_problem("plate_hole[map=edge]");
  const auto& domain = std::get<1>(plate.made)->domain();
  const PointCloud<2> cloud = make_cloud<2>(domain, "grid", LayoutRequest{5, 1});
  // Node i n + j: i the angle, j along the ray.
  EXPECT_NEAR((cloud.nodes.col(0) - Point<2>(0.2, 0)).norm(), 0, 1e-15);
  EXPECT_NEAR((cloud.nodes.col(4) - Point<2>(1, 0)).norm(), 0, 1e-15);
  EXPECT_NEAR((cloud.nodes.col(2 * 5 + 4) - Point<2>(1, 1)).norm(), 0, 1e-15);
  EXPECT_NEAR((cloud.nodes.col(1 * 5 + 4) - Point<2>(1, 0.5)).norm(), 0, 1e-15);
  EXPECT_NEAR((cloud.nodes.col(4 * 5) - Point<2>(0, 0.2)).norm(), 0, 1e-15);
  EXPECT_EQ(cloud.marks_of(2 * 5 + 4).size(), 2U);
  EXPECT_EQ(cloud.marks_of(0).size(), 2U);
  EXPECT_NEAR(cloud.measure, 1 - std::acos(-1.0) / 4 * 0.04, 1e-15);
  const NamedProblem log = make_problem("plate_hole");
  const PointCloud<2> isotropic =
      make_cloud<2>(std::get<1>(log.made)->domain(), "grid", LayoutRequest{5, 1});
  EXPECT_NEAR(isotropic.nodes(0, 2), 0.2 * std::sqrt(5.0), 1e-14);  // a (R/a)^(1/2) on the x axis
}

TEST(Problems, FieldsAreDifferentiatedLikeTheirDifferenceQuotients) {
  for (const char* name : {"trig", "franke", "exponential", "cubic", "runge"}) {
    with_problem<FieldProblem>(
        std::string("field[dim=3,name=") + name + "]", "field",
        [&]<int Dim>(const FieldProblem<Dim>& field) {
          constexpr double h = 1e-5;
          Point<Dim> x = Point<Dim>::Constant(0.4);
          x[0] = 0.3;
          for (int c = 0; c < Dim; ++c) {
            MultiIndex<Dim> first{};
            first[c] = 1;
            const Derivatives<Dim> value{MultiIndex<Dim>{}};
            const double slope = (field.exact(x + h * Point<Dim>::Unit(c), value)[0] -
                                  field.exact(x - h * Point<Dim>::Unit(c), value)[0]) /
                                 (2 * h);
            EXPECT_NEAR(field.exact(x, {first})[0], slope, 1e-6 * (1 + std::abs(slope))) << name;
          }
        });
  }
}

}  // namespace
}  // namespace strongpoint
