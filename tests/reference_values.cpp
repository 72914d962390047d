// Figures known from elsewhere: closed forms, and the reference values of the thesis and of
// independent implementations of it, with their tolerances.
#include <cmath>
#include <numbers>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "methods/core/condition.hpp"
#include "methods/core/error.hpp"
#include "problems/core/assembly.hpp"
#include "studies/support/phases.hpp"
#include "studies/support/run_case.hpp"
#include "tests/contract_support.hpp"

namespace strongpoint {
namespace {

CaseKey key_of(const std::string& problem, const std::string& method, const std::string& stencil,
               int level, const std::string& cloud = "grid") {
  return {problem, method, stencil, cloud, "collocation", "umfpack", level};
}

double quantity(const CaseKey& key, const std::string& name) {
  const CaseResult result = run_steady_case(key, RunOptions{});
  for (const Quantity& q : result.quantities) {
    if (q.name == name) return q.value.value();
  }
  ADD_FAILURE() << "no quantity " << name;
  return 0;
}

/// Condition of mfpm's local matrix with k nearest nodes at one node.
double condition_at(const Points<2>& nodes, int node, int k, Scaling scaling) {
  Sites<2> sites = sites_at_nodes<2>(nodes);
  const auto search = make_search<2>("brute", sites.nodes);
  const std::vector<int> anchors{node};
  const Stencils stencils = search->nearest(columns_of<2>(nodes, anchors), k, Ties::keep);
  return make_method<2>("mfpm").made->condition(sites, anchors, stencils, scaling,
                                                ConditionNorm::two)[0];
}

TEST(ReferenceValues, ConditionOfTheThesisAnnulusStencil) {
  constexpr int n = 21;
  Points<2> nodes(2, n * n);
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      const double angle = std::numbers::pi / 2 * i / (n - 1);
      const double r = 1 + 3.0 * j / (n - 1);
      nodes.col(i * n + j) << r * std::cos(angle), r * std::sin(angle);
    }
  }
  const int node = n / 2 * n;  // r = 1, 45 degrees
  EXPECT_NEAR(condition_at(nodes, node, 10, Scaling::row), 8.1512e3, 0.00005e3);
  EXPECT_NEAR(condition_at(nodes, node, 15, Scaling::row), 2.184e2, 0.0005e2);
}

TEST(ReferenceValues, ConditionOfAPerfectGridAtAnySpacing) {
  for (int n : {11, 81}) {
    const Points<2> nodes = make_cloud<2>(UnitCube<2>{}, "grid", LayoutRequest{n, 1}).nodes;
    EXPECT_NEAR(condition_at(nodes, n / 2 * n + n / 2, 9, Scaling::both), 12.0, 0.05);
    EXPECT_NEAR(condition_at(nodes, n / 2, 9, Scaling::both), 79.5, 0.05);
    EXPECT_NEAR(condition_at(nodes, 0, 9, Scaling::both), 334, 0.5);
  }
}

TEST(ReferenceValues, TwoPointProblemMatchesItsRowTo1Percent) {
  const std::pair<int, double> rows[] = {{11, 7.84e-3}, {161, 3.20e-5}, {1281, 5.01e-7}};
  for (const auto& [level, error] : rows) {
    EXPECT_NEAR(quantity(key_of("bvp_1d", "mfpm", "nearest[k=3]", level), "u_error") / error, 1,
                0.01);
  }
  // Crowding the right end with alpha = 0.5 leaves order 1.5. Stencils are the neighbours on either
  // side: the three nearest nodes leave the left end to itself, and the system singular.
  const double coarse =
      quantity(key_of("bvp_1d[alpha=0.5]", "mfpm", "star[per_sector=1]", 161), "u_error");
  const double fine =
      quantity(key_of("bvp_1d[alpha=0.5]", "mfpm", "star[per_sector=1]", 1281), "u_error");
  EXPECT_NEAR(std::log2(coarse / fine) / 3, 1.5, 0.05);
  EXPECT_THROW(quantity(key_of("bvp_1d[alpha=0.5]", "mfpm", "nearest[k=3]", 161), "u_error"),
               CaseError);
}

/// Weights of first and second derivatives on three nodes. Source: closed form, LeVeque 2007, 1.5.
TEST(ReferenceValues, MfpmOnThreeNodesEqualsFiniteDifferences) {
  for (const char* method : {"mfpm", "mfpm_original", "gfdm", "lsfdm"}) {
    Points<1> nodes(1, 3);
    nodes << 0.3, 0.37, 0.5;
    Sites<1> sites = sites_at_nodes<1>(nodes);
    sites.volumes = Eigen::Vector3d(0.07, 0.1, 0.13);
    Stencils stencils;
    for (int a = 0; a < 3; ++a) {
      std::vector<int> all{0, 1, 2};
      sort_stencil<1>(sites, a, all);
      stencils.push_back(all);
    }
    const Weights weights = make_method<1>(method).made->weights(sites, stencils, {{1}, {2}});
    for (int a = 0; a < 3; ++a) {
      for (int j = 0; j < 3; ++j) {
        const int node = weights.nodes(a)[j];
        const double p = nodes((node + 1) % 3);
        const double q = nodes((node + 2) % 3);
        const double below = (nodes(node) - p) * (nodes(node) - q);
        EXPECT_NEAR(weights.row(a)(0, j), (2 * nodes(a) - p - q) / below, 1e-10 * 1e2) << method;
        EXPECT_NEAR(weights.row(a)(1, j) * below, 2, 1e-10) << method;
      }
    }
  }
}

TEST(ReferenceValues, TwoPointProblemEqualsTheFiniteDifferenceSolutionTo1em10) {
  // u'' on three equidistant nodes, one-sided second-order u' at the right end, solved
  // independently.
  constexpr int n = 81;
  const double h = 1.0 / (n - 1);
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(n, n);
  Eigen::VectorXd rhs = Eigen::VectorXd::Zero(n);
  matrix(0, 0) = 1;
  for (int i = 1; i + 1 < n; ++i) {
    matrix.row(i).segment(i - 1, 3) << 1 / (h * h), -2 / (h * h), 1 / (h * h);
    rhs[i] = -std::exp(i * h);
  }
  matrix.row(n - 1).tail(3) << 0.5 / h, -2 / h, 1.5 / h;
  const Eigen::VectorXd expected = matrix.partialPivLu().solve(rhs);
  Eigen::VectorXd exact(n);
  for (int i = 0; i < n; ++i) exact[i] = -std::exp(i * h) + std::exp(1.0) * i * h + 1;
  const double error = (expected - exact).norm() / exact.norm();
  EXPECT_NEAR(quantity(key_of("bvp_1d", "mfpm", "nearest[k=3]", n), "u_error"), error, 1e-10);
}

struct PlateRow {
  int level;
  double sif, displacement, stress_xx;
};

TEST(ReferenceValues, PlateWithZonedStencilsOnTheLogMap) {
  const std::string method = "zoned";
  const std::string stencil = "zoned[interior=nearest[k=9],boundary=nearest[k=15]]";
  for (const PlateRow& row :
       {PlateRow{21, 7.90e-2, 1.25e-2, 3.32e-2}, PlateRow{41, 2.01e-2, 2.86e-3, 7.59e-3},
        PlateRow{81, 4.99e-3, 7.13e-4, 1.85e-3}}) {
    const CaseKey key = key_of("plate_hole", method, stencil, row.level);
    EXPECT_NEAR(quantity(key, "sif_error") / row.sif, 1, 0.03);
    EXPECT_NEAR(quantity(key, "displacement_error") / row.displacement, 1, 0.03);
    EXPECT_NEAR(quantity(key, "stress_xx_error") / row.stress_xx, 1, 0.03);
  }
}

TEST(ReferenceValues, PlateOnTheEdgeMapWithIndexBlocks) {
  for (const PlateRow& row : {PlateRow{21, 3.3e-1, 1.1e-1, 0}, PlateRow{41, 9.1e-2, 2.7e-2, 0},
                              PlateRow{81, 2.5e-2, 6.6e-3, 0}}) {
    const CaseKey key = key_of("plate_hole[map=edge]", "mfpm", "block", row.level);
    EXPECT_NEAR(quantity(key, "sif_error") / row.sif, 1, 0.1);
    EXPECT_NEAR(quantity(key, "displacement_error") / row.displacement, 1, 0.1);
  }
}

TEST(ReferenceValues, PlateWithTheOriginalFormulation) {
  for (const PlateRow& row :
       {PlateRow{21, 8.6e-2, 0, 0}, PlateRow{41, 2.1e-2, 0, 0}, PlateRow{81, 5.5e-3, 0, 0}}) {
    const CaseKey key = key_of("plate_hole", "mfpm_original", "grow_until", row.level);
    EXPECT_NEAR(quantity(key, "sif_error") / row.sif, 1, 0.1);
  }
}

TEST(ReferenceValues, RbfFdOfDegree4HasOrder4) {
  const auto at = [](int level) {
    return quantity(
        key_of("poisson_square", "rbf_fd[degree=4]", "nearest[k=30]", level, "perturbed"),
        "u_error");
  };
  EXPECT_NEAR(std::log2(at(21) / at(81)) / 2, 4, 0.5);
}

TEST(ReferenceValues, GfdmWithUnitWeightIsMfpmAndOriginalOnEqualVolumesToo) {
  TestScene<2> scene = make_scene<2>("mfpm", "perturbed", 15, 1);
  const Derivatives<2> all = Derivatives<2>::between_orders(1, 2);
  const Weights novel = scene.method->weights(scene.sites, scene.stencils, all);
  const Weights gfdm =
      make_method<2>("gfdm[weight=one]").made->weights(scene.sites, scene.stencils, all);
  scene.sites.volumes = Eigen::VectorXd::Constant(scene.sites.node_count(), 0.004);
  const Weights original =
      make_method<2>("mfpm_original").made->weights(scene.sites, scene.stencils, all);
  for (std::size_t i = 0; i < novel.values.size(); ++i) {
    const double scale = 1 + std::abs(novel.values[i]);
    EXPECT_LT(std::abs(gfdm.values[i] - novel.values[i]) / scale, 1e-12);
    EXPECT_LT(std::abs(original.values[i] - novel.values[i]) / scale, 1e-11);
  }
}

TEST(ReferenceValues, UnfusedPhasesGiveTheOperatorsOfTheFusedRun) {
  const PointCloud<2> cloud = make_cloud<2>(UnitCube<2>{}, "perturbed", LayoutRequest{21, 1});
  for (const char* name : {"mfpm", "lsfdm"}) {
    const auto method = make_method<2>(name).made;
    const auto& taylor = dynamic_cast<const TaylorMethod<2>&>(*method);
    for (const PhaseAlgorithm algorithm : {PhaseAlgorithm::sort, PhaseAlgorithm::cells}) {
      const PhaseRun run = run_phases<2>(cloud, Eigen::VectorXd(), taylor.kernel(),
                                         taylor.stencil_size(), algorithm);
      const Weights fused = method->weights(sites_at_nodes<2>(cloud.nodes), run.stencils,
                                            taylor.kernel().monomials());
      ASSERT_EQ(fused.values.size(), run.weights.values.size());
      for (int p = 0; p < fused.size(); ++p) {
        const double scale = fused.row(p).cwiseAbs().maxCoeff();
        EXPECT_LT((fused.row(p) - run.weights.row(p)).cwiseAbs().maxCoeff(), 1e-8 * scale) << name;
      }
      for (double seconds : run.seconds) EXPECT_GE(seconds, 0);
    }
  }
}

TEST(ReferenceValues, NovelFormulationSpendsNothingOnVoronoiCells) {
  const RunOptions options;
  EXPECT_EQ(run_steady_case(key_of("plate_hole", "mfpm", "grow_until", 21), options).times.voronoi,
            0);
  EXPECT_GT(run_steady_case(key_of("plate_hole", "mfpm_original", "grow_until", 21), options)
                .times.voronoi,
            0);
}

}  // namespace
}  // namespace strongpoint
