// Clouds of several parts: who meets whom, that stencils stay at home, what holds on interfaces.
#include <algorithm>
#include <cmath>
#include <numeric>

#include <gtest/gtest.h>

#include "methods/core/parts.hpp"
#include "problems/core/layout.hpp"
#include "studies/support/run_case.hpp"
#include "tests/steady_cases.hpp"

namespace strongpoint {
namespace {

constexpr const char* patches = "two_materials";
/// Two materials have a piecewise linear solution, which a method of degree 1 meets but for
/// round-off times the condition of the system, 1e4 at most here.
constexpr double exact_tolerance = 1e-9;

PointCloud<2> cloud_of(const std::string& problem, const std::string& cloud, int level) {
  const NamedProblem named = make_problem(problem);
  return make_cloud<2>(std::get<1>(named.made)->domain(), cloud, LayoutRequest{level, 1});
}

TEST(Patches, MeetNodeOnNodeWithOppositeNormals) {
  const PointCloud<2> cloud = cloud_of(patches, "grid", 5);
  ASSERT_EQ(cloud.parts.size(), 2U);
  ASSERT_EQ(cloud.size(), 50);
  int met = 0;
  for (int i = 0; i < cloud.size(); ++i) {
    EXPECT_EQ(cloud.part_of(i), i < 25 ? 0 : 1);
    EXPECT_EQ(cloud.patch_of(i), cloud.part_of(i));
    const bool is_met = cloud.nodes(0, i) == 1;
    EXPECT_EQ(cloud.interfaces_of(i).size(), is_met ? 1U : 0U);
    ASSERT_EQ(cloud.twins_of(i).size(), is_met ? 1U : 0U);
    for (const BoundaryMark<2>& mark : cloud.marks_of(i)) EXPECT_GE(mark.side, 0);
    if (!is_met) continue;
    const int twin = cloud.twins_of(i)[0];
    EXPECT_NE(cloud.part_of(i), cloud.part_of(twin));
    EXPECT_EQ(cloud.nodes.col(i), cloud.nodes.col(twin));
    EXPECT_EQ(cloud.interfaces_of(i)[0].normal, -cloud.interfaces_of(twin)[0].normal);
    EXPECT_TRUE(cloud.is_boundary(i));
    ++met;
  }
  EXPECT_EQ(met, 10);
}

TEST(Patches, AreRefusedWhereTheirNodesDoNotMeet) {
  try {
    cloud_of(patches, "perturbed[boundary=slide]", 7);
    FAIL() << "nodes met that had slid along the interface";
  } catch (const CaseError& error) {
    EXPECT_NE(std::string(error.what()).find("lies on an interface"), std::string::npos)
        << error.what();
  }
  EXPECT_THROW(cloud_of(patches, "file[path=none.msh]", 7), SkipCase);
}

TEST(Patches, KeepStencilsAndWeightsToThemselves) {
  with_problem<SteadyProblem>(patches, "steady", [](const auto& problem) {
    StageTimes times;
    for (const char* method : {"lsfdm", "mfpm_original", "kansa"}) {
      const CaseKey key = steady_case(patches, method, "scattered", 8);
      const auto made = discretise(problem, key, RunOptions{}, times);
      for (int i = 0; i < made->cloud.size(); ++i) {
        EXPECT_FALSE(made->weights.nodes(i).empty());
        for (int node : made->weights.nodes(i)) {
          EXPECT_EQ(made->cloud.part_of(node), made->cloud.part_of(i)) << method;
        }
      }
    }
  });
}

/// Rows of the whole, computed part by part, are those of each part by itself.
TEST(Patches, WeightsArePastedTogetherRowByRow) {
  const PointCloud<2> cloud = cloud_of(patches, "perturbed", 6);
  const Sites<2> sites = sites_of_cloud<2>(cloud);
  const std::vector<PartSites<2>> parts = split_by_part<2>(sites);
  ASSERT_EQ(parts.size(), 2U);
  std::vector<Weights> weights(2);
  for (int p = 0; p < 2; ++p) {
    EXPECT_EQ(parts[p].sites.nodes, cloud.nodes.middleCols(p * 36, 36));
    weights[p].per_entry = 1;
    for (int i = 0; i < 36; ++i) {  // each point reads its own node with its id as weight
      weights[p].columns.push_back(i);
      weights[p].values.push_back(100 * p + i);
      weights[p].offsets.push_back(i + 1);
    }
  }
  const Weights all = join_weights<2>(parts, weights);
  for (int i = 0; i < 72; ++i) {
    EXPECT_EQ(all.nodes(i)[0], i);
    EXPECT_EQ(all.row(i)(0, 0), i < 36 ? i : 100 + i - 36);
  }
  Sites<2> broken = sites;
  broken.node_part.pop_back();
  EXPECT_THROW(split_by_part<2>(broken), CaseError);
}

/// On blocks that are the same but for their place, stencils have the conditions of one block.
TEST(Patches, JudgeStencilsPartByPart) {
  with_problem<SteadyProblem>(patches, "steady", []<int Dim>(const SteadyProblem<Dim>& problem) {
    StageTimes times;
    const CaseKey key = steady_case(patches, "fdm[order=4,exact=mapped]", "grid", 6);
    const auto made = discretise(problem, key, RunOptions{}, times);
    std::vector<int> anchors(72);
    std::iota(anchors.begin(), anchors.end(), 0);
    const std::vector<double> conditions =
        condition_by_part(*make_method<Dim>(key.method).made, made->sites, anchors, made->stencils,
                          Scaling::both, ConditionNorm::two);
    for (int i = 0; i < 36; ++i) {
      EXPECT_NEAR(conditions[i], 1, 1e-12);  // lines at right angles
      EXPECT_NEAR(conditions[i + 36], 1, 1e-12);
    }
  });
}

TEST(TwoMaterials, AreExactAsPatches) {
  for (const char* method : {"mfpm", "mfpm_original", "lsfdm", "rpim", "rbf_fd", "gmls", "cspm"}) {
    for (const char* cloud : {"grid", "perturbed", "scattered"}) {
      for (const double error : errors_of(steady_case(patches, method, cloud, 9))) {
        EXPECT_LT(error, exact_tolerance) << method << " on " << cloud;
      }
    }
  }
  for (const char* cloud : {"blocks[nodes=gll]", "blocks[nodes=uniform,split=2]"}) {
    for (const char* method : {"fdm[order=4,exact=mapped]", "lsfdm"}) {
      for (const double error : errors_of(steady_case(patches, method, cloud, 6))) {
        EXPECT_LT(error, exact_tolerance) << method << " on " << cloud;
      }
    }
  }
}

TEST(TwoMaterials, AreExactWithAPressureThatJumps) {
  for (const double error :
       errors_of(steady_case("two_materials[unknowns=mixed]", "lsfdm", "grid", 9))) {
    EXPECT_LT(error, exact_tolerance);
  }
}

/// The thesis' other strategy: the error at a jump does not vanish with the spacing. The bounds
/// hold what was found, 25 to 31 % in displacement on grids.
TEST(TwoMaterials, AreWrongByAQuarterWithVaryingCoefficientsHoweverFine) {
  for (const int level : {11, 21, 41}) {
    const double error =
        errors_of(steady_case("two_materials[strategy=variable]", "lsfdm", "grid", level))[0];
    EXPECT_GT(error, 0.2) << level;
    EXPECT_LT(error, 0.35) << level;
  }
}

TEST(GradedMaterial, ConvergesAtSecondOrder) {
  for (const char* method : {"lsfdm", "mfpm"}) {
    const double coarse = errors_of(steady_case("graded_material", method, "grid", 17))[0];
    const double fine = errors_of(steady_case("graded_material", method, "grid", 33))[0];
    EXPECT_NEAR(std::log2(coarse / fine), 2, 0.3) << method;
  }
}

TEST(Patches, AreDeclinedByFormsThatDoNotJoinThem) {
  for (const char* form : {"collocation[boundary=ghost]", "collocation[symmetry=images]"}) {
    CaseKey key = steady_case(patches, "lsfdm", "grid", 7);
    key.form = form;
    EXPECT_THROW(run_steady_case(key, RunOptions{}), SkipCase) << form;
  }
  EXPECT_THROW(run_steady_case(steady_case("plate_hole", "sph", "blocks", 7), RunOptions{}),
               SkipCase)
      << "cell volumes of blocks";
}

TEST(Patches, GiveTheSameBitsOnAnyNumberOfThreads) {
  const CaseKey key = steady_case("plate_hole", "lsfdm", "blocks[split=2]", 7);
  RunOptions two;
  two.threads = 2;
  const auto one = run_steady_case(key, RunOptions{}).quantities;
  const auto both = run_steady_case(key, two).quantities;
  for (std::size_t q = 0; q < one.size(); ++q) EXPECT_EQ(*one[q].value, *both[q].value);
}

}  // namespace
}  // namespace strongpoint
