// Data of the elasticity problems: exact solutions satisfy them, probes read what they say.
#include <cmath>
#include <functional>
#include <numbers>

#include "problems/core/form.hpp"
#include "problems/core/jet.hpp"
#include "problems/core/probes.hpp"
#include "problems/core/radial_lame.hpp"
#include "studies/support/run_case.hpp"
#include "tests/cloud_checks.hpp"

namespace strongpoint {
namespace {

/// Round-off of sums of second derivatives of size 100, and of products of stiffnesses of size 1000
/// with second derivatives of size 10.
constexpr double stress_tolerance = 1e-10;

/// Displacement gradient, gradient(i, j) = d u_i / d x_j, of jets.
template <int Dim, int Order>
Eigen::Matrix<double, Dim, Dim> gradient_of(const std::array<Jet<Dim, Order>, Dim>& u) {
  Eigen::Matrix<double, Dim, Dim> gradient;
  for (int i = 0; i < Dim; ++i) {
    for (int j = 0; j < Dim; ++j) gradient(i, j) = u[i].derivative(partial<Dim>(j));
  }
  return gradient;
}

/// Component i of div sigma from second derivatives.
template <int Dim>
double divergence_of_stress(const Lame& material, const std::array<Jet<Dim, 2>, Dim>& u, int i) {
  double sum = 0;
  for (int j = 0; j < Dim; ++j) {
    sum += material.mu * u[i].derivative(partial<Dim>(j, j)) +
           (material.lambda + material.mu) * u[j].derivative(partial<Dim>(i, j));
  }
  return sum;
}

template <int Dim>
void expect_lame(double a, double b, const Point<Dim>& direction) {
  const Lame material = lame_constants(1000, 0.3);
  const RadialLame<Dim> exact(a, b, 2, material);
  const Point<Dim> n = direction.normalized();
  for (const double r : {a, 0.5 * (a + b), b}) {
    const auto u = jets_at<Dim, 2>(exact, Point<Dim>(r * n));
    for (int i = 0; i < Dim; ++i) {
      EXPECT_NEAR(divergence_of_stress<Dim>(material, u, i), 0, stress_tolerance);
    }
    const auto sigma = stress<Dim>(material, gradient_of<Dim, 2>(u));
    const double inner = std::pow(a, Dim), outer = std::pow(b, Dim), here = std::pow(r, Dim);
    // Timoshenko and Goodier's stresses: -p at a, 0 at b, and the hoop stress.
    const double load = 2 * inner / (outer - inner);
    const double radial = load * (1 - outer / here);
    const double hoop = load * (1 + outer / (here * (Dim - 1)));
    EXPECT_NEAR(n.dot(sigma * n), radial, stress_tolerance);
    EXPECT_NEAR(sigma.trace() - n.dot(sigma * n), (Dim - 1) * hoop, stress_tolerance);
    EXPECT_NEAR((sigma * n - radial * n).norm(), 0, stress_tolerance);
  }
}

TEST(RadialLame, IsInEquilibriumUnderPressureInside) {
  expect_lame<2>(1, 4, {2, 1});
  expect_lame<3>(1, 2, {2, 1, 3});
}

/// Largest misfit of the equations of a problem, at all nodes of a cloud, with exact displacements.
template <int Dim, class Exact>
double misfit(const std::string& spec, const std::string& layout, int level, const Exact& exact) {
  const NamedProblem named = make_problem(spec);
  const auto& base = std::get<std::unique_ptr<Problem<Dim>>>(named.made);
  const auto& problem = dynamic_cast<const SteadyProblem<Dim>&>(*base);
  const PointCloud<Dim> cloud = make_cloud<Dim>(problem.domain(), layout, {level, 1});
  const Derivatives<Dim> all = Derivatives<Dim>::between_orders(0, 2);
  double worst = 0;
  for (int i = 0; i < cloud.size(); ++i) {
    EquationList list;
    EquationWriter<Dim> write(list, all);
    problem.equations(node_of(cloud, i), write);
    const auto u = jets_at<Dim, 2>(exact, Point<Dim>(cloud.nodes.col(i)));
    EXPECT_EQ(list.size(), Dim);
    for (int row = 0; row < list.size(); ++row) {
      double sum = -list.right_hand_sides[row];
      for (const Term& term : list.row(row)) {
        sum += term.coefficient * u[term.field].derivative(all[term.derivative]);
      }
      worst = std::max(worst, std::abs(sum));
    }
  }
  return worst;
}

/// The displacements of elastic_cube, written out.
struct CubeWaves {
  template <class T>
  std::array<T, 3> operator()(const std::array<T, 3>& x) const {
    const double pi = std::numbers::pi;
    std::array<T, 3> u;
    for (int i = 0; i < 3; ++i) {
      u[i] = sin(pi * x[0] / 2.0 + i) * cos(pi * x[1] / 3.0) * sin(pi * x[2] / 4.0 + 1.0);
    }
    return u;
  }
};

TEST(ElasticProblems, HaveTheExactSolutionsTheyAreJudgedBy) {
  const Lame material = lame_constants(1000, 0.3);
  const RadialLame<2> tube(1, 4, 1, material);
  for (const char* spec : {"thick_cylinder", "thick_cylinder[radii=uniform]"}) {
    EXPECT_LT(misfit<2>(spec, "grid", 9, tube), stress_tolerance) << spec;
    EXPECT_LT(misfit<2>(spec, "scattered", 9, tube), stress_tolerance) << spec;
  }
  const RadialLame<3> sphere(1, 2, 1, material);
  EXPECT_LT(misfit<3>("thick_sphere", "scattered", 9, sphere), stress_tolerance);
  EXPECT_LT(misfit<3>("elastic_cube", "grid", 5, CubeWaves{}), stress_tolerance);
  EXPECT_LT(misfit<3>("elastic_cube[traction=one]", "grid", 5, CubeWaves{}), stress_tolerance);
}

/// Quantities of a case by name.
std::map<std::string, double> quantities(const CaseKey& key) {
  std::map<std::string, double> found;
  for (const auto& quantity : run_steady_case(key, RunOptions{}).quantities) {
    found[quantity.name] = quantity.value.value();
  }
  return found;
}

/// The figures measured on other code, to 0.2 %. On this grid of flat cells the fifteen nearest
/// nodes of a node on the loaded side fill two columns only, on which a quadratic is not unique, so
/// that stencils have to grow there; any bound of the condition from 1e4 to 1e8 gives these.
TEST(Cook, GivesTheKnownDisplacementsOnMappedGrids) {
  const std::pair<int, double> known[] = {{21, 23.43}, {41, 23.03}, {81, 22.86}};
  for (const auto& [level, corner] : known) {
    const auto found = quantities({"cook[nu=0.33]", "lsfdm", "grow_until[cond_max=1e4]", "grid",
                                   "collocation", "umfpack", level});
    EXPECT_NEAR(found.at("v_corner"), corner, 2e-3 * corner);
    EXPECT_DOUBLE_EQ(found.at("v_corner_error"), std::abs(found.at("v_corner") / 22.6578 - 1));
    EXPECT_DOUBLE_EQ(found.at("v_mid_error"), std::abs(found.at("v_mid") / 21.5692 - 1));
  }
}

/// Cook's membrane with a field as its solution.
std::vector<double> judge_cook(const std::string& spec, const std::string& layout, int level,
                               const std::function<double(const Point<2>&)>& v) {
  const NamedProblem named = make_problem(spec);
  const auto& problem = dynamic_cast<const SteadyProblem<2>&>(*std::get<1>(named.made));
  const PointCloud<2> cloud = make_cloud<2>(problem.domain(), layout, {level, 1});
  Eigen::MatrixXd fields = Eigen::MatrixXd::Zero(2, cloud.size());
  for (int i = 0; i < cloud.size(); ++i) fields(1, i) = v(cloud.nodes.col(i));
  const Weights none;
  const Derivatives<2> derivatives;
  return problem.measure(Solution<2>{cloud, fields, fields, none, derivatives});
}

TEST(Cook, ReadsItsDisplacementsAtTheCornerAndTheMiddleOfTheLoadedSide) {
  const auto linear = [](const Point<2>& x) { return x[0] + 2 * x[1]; };
  // Even levels have no node at (48, 52), and clouds neither.
  for (const auto& [layout, level] : {std::pair("grid", 5), std::pair("grid", 6),
                                      std::pair("scattered", 12), std::pair("random", 12)}) {
    const std::vector<double> found = judge_cook("cook", layout, level, linear);
    ASSERT_EQ(found.size(), 4U);
    EXPECT_NEAR(found[0], 168, 1e-11) << layout << level;
    EXPECT_NEAR(found[1], 152, 1e-11) << layout << level;
  }
}

TEST(Cook, HasErrorsWhereAReferenceIsKnown) {
  const auto zero = [](const Point<2>&) { return 0.0; };
  EXPECT_EQ(judge_cook("cook[nu=0.49]", "grid", 5, zero).size(), 4U);
  EXPECT_EQ(judge_cook("cook[nu=0.4]", "grid", 5, zero).size(), 2U);
}

TEST(Cook, TakesBothTractionsOfTheLoadedSideAtItsCorners) {
  const NamedProblem named = make_problem("cook");
  const auto& problem = dynamic_cast<const SteadyProblem<2>&>(*std::get<1>(named.made));
  const PointCloud<2> cloud = make_cloud<2>(problem.domain(), "grid", {5, 1});
  for (const Point<2>& corner : {Point<2>(48, 44), Point<2>(48, 60)}) {
    EquationList list;
    const Derivatives<2> all = Derivatives<2>::between_orders(0, 2);
    EquationWriter<2> write(list, all);
    problem.equations(node_of(cloud, node_at<2>(cloud, corner)), write);
    EXPECT_EQ(list.right_hand_sides, (LargeArray<double>{0, 1.0 / 16}));
  }
}

TEST(Probes, RefuseACloudWithoutANodeThere) {
  const PointCloud<2> cloud = unit_cloud<2>("grid", 3);
  EXPECT_EQ(node_at<2>(cloud, {0.5, 1}), 5);
  const std::string message = message_of([&] { node_at<2>(cloud, {0.5, 0.9}); });
  EXPECT_NE(message.find("(0.5, 0.9), where the cloud has no node"), std::string::npos) << message;
}

/// Degree 2 without ghosts or images, T = 1/r: slow, but robust where others are erratic in 3D.
CaseKey cheap_3d(const std::string& problem, int seed, int level) {
  return {problem,
          "gfdm[weight=power[p=2]]",
          "nearest[k=35]",
          "scattered[seed=" + std::to_string(seed) + "]",
          "collocation[symmetry=rows]",
          "umfpack",
          level};
}

TEST(ThickSphere, ConvergesAtSecondOrderOnScatteredNodes) {
  for (int seed = 1; seed <= 3; ++seed) {
    const double coarse = quantities(cheap_3d("thick_sphere", seed, 9)).at("displacement_error");
    const double fine = quantities(cheap_3d("thick_sphere", seed, 17)).at("displacement_error");
    EXPECT_LT(fine, coarse / 4) << seed;
    EXPECT_LT(fine, 0.07) << seed;  // measured 0.050 to 0.056
  }
}

/// Known from other code on other nodes: stress_xx_y = 361 and 355, u_end = 0.717 and 0.710 with
/// 3 700 and 7 400 nodes; bands of 3 % and 1 % hold seeds 1 to 4 with 3 300. The stresses on the x
/// axis are known of the exact solution alone, which this method misses by up to 17 % so far.
TEST(BlockBore, ComesNearTheKnownFiguresWithACheapMethod) {
  const auto found = quantities(cheap_3d("block_bore", 1, 15));
  EXPECT_NEAR(found.at("stress_xx_y"), 361, 0.03 * 361);
  EXPECT_NEAR(found.at("u_end"), 0.717, 0.01 * 0.717);
  EXPECT_DOUBLE_EQ(found.at("u_end_error"), std::abs(found.at("u_end") / 0.70307 - 1));
  for (const char* name : {"stress_xx_z_error", "stress_zz_x_error", "stress_yy_x_error"}) {
    EXPECT_LT(found.at(name), 0.2) << name;
  }
}

}  // namespace
}  // namespace strongpoint
