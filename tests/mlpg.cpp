// The form mlpg: patch tests, convergence, what it declines.
#include <algorithm>
#include <array>
#include <cmath>

#include <gtest/gtest.h>
#include <omp.h>

#include "problems/core/assembly.hpp"
#include "problems/core/manufactured_poisson.hpp"
#include "studies/support/run_case.hpp"
#include "tests/strain_problem.hpp"

namespace strongpoint {
namespace {

using Point2 = Point<2>;

/// The domain of plate_hole with a hole of radius 0.2.
const Domain<2>& plate_domain() {
  static const NamedProblem plate = make_problem("plate_hole");
  return std::get<1>(plate.made)->domain();
}

/// u = 3 - 2x + y/2, of which every method of degree 1 is to give the very values.
struct LinearField {
  template <class T>
  T operator()(const std::array<T, 2>& x) const {
    return 3.0 - 2.0 * x[0] + 0.5 * x[1];
  }
};

/// Nodal parameters of a problem written in the form.
template <class Problem>
Eigen::MatrixXd solved(const Problem& problem, const std::string& form, const std::string& method,
                       const std::string& cloud, PointCloud<2>& nodes) {
  const CaseKey key{"",        method, make_method<2>(method).made->default_stencil(), cloud, form,
                    "umfpack", 12};
  StageTimes times;
  const auto made = discretise<2>(problem, key, RunOptions{}, times);
  const Discretisation<2>& scene = *made;
  const int fields = static_cast<int>(problem.fields().size());
  const LinearSystem system =
      assemble(scene.equations(scene.derivatives), scene.weights, scene.unknowns, fields);
  const LinearSolution linear = solve(system, "umfpack");
  nodes = scene.cloud;
  return Eigen::Map<const Eigen::MatrixXd>(linear.x.data(), fields, scene.cloud.size());
}

/// Given values and whole discs leave round-off alone. The area and the edge of a cut disc agree to
/// the accuracy of the quadrature, so that given fluxes need more points (the default leaves 2e-8).
constexpr double patch_tolerance = 1e-8;
const char* const fine = "mlpg[radial=8,angular=24]";

TEST(Mlpg, PassesThePatchTestOfPoisson) {
  for (const char* method : {"mls", "mls[h=1.3]", "mls[degree=1]", "rbf_fd"}) {
    for (const char* cloud : {"grid", "perturbed[amount=0.3]", "scattered"}) {
      for (const RightSide right : {RightSide::dirichlet, RightSide::neumann}) {
        const ManufacturedPoisson<2, LinearField> problem(right);
        PointCloud<2> nodes;
        const char* form = right == RightSide::dirichlet ? "mlpg" : fine;
        const Eigen::MatrixXd parameters = solved(problem, form, method, cloud, nodes);
        for (int i = 0; i < nodes.size(); ++i) {
          const double exact = LinearField{}(std::array{nodes.nodes(0, i), nodes.nodes(1, i)});
          EXPECT_NEAR(parameters(0, i), exact, patch_tolerance) << method << " on " << cloud;
        }
      }
    }
  }
}

TEST(Mlpg, PassesThePatchTestOfElasticityWithDisplacementsAndTractions) {
  const UnitCube<2> square;
  const std::vector<std::string> all{"left", "right", "bottom", "top"};
  struct Case {
    const Domain<2>& domain;
    std::vector<std::string> clamped;
    const char* form;
  };
  for (const Case& c : {Case{square, all, "mlpg"}, Case{square, {"left"}, fine},
                        Case{plate_domain(), {"bottom"}, fine}}) {
    for (const char* cloud : {"grid", "perturbed[amount=0.3]", "scattered"}) {
      const HomogeneousStrain<2> problem(c.domain, c.clamped);
      PointCloud<2> nodes;
      const Eigen::MatrixXd parameters = solved(problem, c.form, "mls[h=1.3]", cloud, nodes);
      for (int i = 0; i < nodes.size(); ++i) {
        const Point2 exact = problem.displacement(nodes.nodes.col(i));
        EXPECT_LT((parameters.col(i) - exact).norm(), patch_tolerance) << cloud;
      }
    }
  }
}

/// What a problem measures on a grid, solved with moving least squares on about 21 nodes.
std::vector<Quantity> measured(const std::string& problem, const std::string& form, int level) {
  const CaseKey key{problem, "mls[h=1.3]", "radius", "grid", form, "umfpack", level};
  return run_steady_case(key, RunOptions{}).quantities;
}

/// Measured orders: 2.2 (Poisson), 2.1 and 2.4 (displacement and stress).
TEST(Mlpg, ConvergesAtSecondOrder) {
  for (const char* problem : {"poisson_square", "poisson_square[bc=mixed]", "plate_hole"}) {
    const std::vector<Quantity> coarse = measured(problem, "mlpg", 21);
    const std::vector<Quantity> refined = measured(problem, "mlpg", 41);
    const double bound = std::string(problem) == "plate_hole" ? 0.03 : 1.5e-4;
    for (std::size_t q = 0; q < coarse.size(); ++q) {
      EXPECT_LT(coarse[q].value.value(), bound) << problem << ' ' << coarse[q].name;
      EXPECT_LT(refined[q].value.value(), coarse[q].value.value() / 3.3)
          << problem << ' ' << coarse[q].name;
    }
  }
}

TEST(Mlpg, HasEnoughQuadraturePointsByDefault) {
  for (const char* problem : {"poisson_square[bc=mixed]", "plate_hole"}) {
    const double few = measured(problem, "mlpg", 21).back().value.value();
    const double many = measured(problem, "mlpg[radial=10,angular=20]", 21).back().value.value();
    EXPECT_LT(std::abs(few - many), 0.15 * many) << problem;
  }
}

TEST(Mlpg, WritesTheSameSystemOnOneAndFourThreads) {
  const ManufacturedPoisson<2, LinearField> problem(RightSide::neumann);
  PointCloud<2> nodes;
  RunOptions options;
  const CaseKey key{"", "mls", "radius[factor=3.2]", "perturbed", "mlpg", "umfpack", 12};
  StageTimes times;
  LargeArray<double> values[2];
  for (int i = 0; i < 2; ++i) {
    options.threads = i == 0 ? 1 : 4;
    const auto made = discretise<2>(problem, key, options, times);
    const Discretisation<2>& scene = *made;
    values[i] =
        assemble(scene.equations(scene.derivatives), scene.weights, scene.unknowns, 1).values;
  }
  omp_set_num_threads(1);
  EXPECT_EQ(values[0], values[1]);
}

TEST(Mlpg, EvaluatesAtTheNodesOnlyWhatIsRead) {
  const ManufacturedPoisson<2, LinearField> problem(RightSide::dirichlet);
  StageTimes times;
  for (const char* method : {"rbf_fd", "mls"}) {
    const CaseKey key{"", method, "radius", "grid", "mlpg", "umfpack", 6};
    const auto made = discretise<2>(problem, key, RunOptions{}, times);
    const Discretisation<2>& scene = *made;
    const bool interpolates = make_method<2>(method).made->promises().interpolates;
    EXPECT_EQ(scene.derivatives.size(), interpolates ? 2 : 3) << method;
    EXPECT_EQ(scene.sites.point_count(), 36 + 16 * 72) << method;  // 16 discs inside
    for (int p = 0; p < scene.sites.point_count(); ++p) {
      EXPECT_EQ(scene.weights.nodes(p).empty(), interpolates && p < 36) << method;
    }
  }
}

TEST(Mlpg, DeclinesWithAReason) {
  const ManufacturedPoisson<2, LinearField> square(RightSide::dirichlet);
  const auto form = make_form<2>("mlpg");
  EXPECT_EQ(form->unsupported(square, *make_method<2>("mls").made), "");
  EXPECT_NE(form->unsupported(square, *make_method<2>("mfpm").made).find("node at the centre"),
            std::string::npos);
  for (const char* problem : {"bvp_1d", "poisson_cube"}) {
    const CaseKey key{problem, "mls", "radius", "grid", "mlpg", "umfpack", 5};
    try {
      run_steady_case(key, RunOptions{});
      FAIL() << problem << " is not two-dimensional";
    } catch (const SkipCase& skipped) {
      EXPECT_NE(std::string(skipped.what()).find("2D only"), std::string::npos);
    }
  }
}

}  // namespace
}  // namespace strongpoint
