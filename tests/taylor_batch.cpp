// Taylor fits side by side: each path against fits made one by one, in any company.
#include <algorithm>

#include <gtest/gtest.h>
#include <omp.h>

#include "methods/core/condition.hpp"
#include "methods/core/taylor_fit.hpp"
#include "tests/batch_checks.hpp"

namespace strongpoint {
namespace {

/// Round-off of systems of condition up to 1e6, of which refinement leaves the square root.
constexpr double tolerance = 1e-9;

template <int Dim>
void matches_fits(const std::string& spec, int order, const std::string& cloud) {
  SCOPED_TRACE(spec + " on " + cloud);
  const auto scene = make_scene<Dim>(spec, cloud, test_level<Dim>(order), 1);
  const auto& method = dynamic_cast<const TaylorMethod<Dim>&>(*scene.method);
  const Sites<Dim> sites = with_points_between<Dim>(scene.sites, 0.1);
  const auto derivatives = Derivatives<Dim>::between_orders(0, order);
  const Weights expected =
      weights_one_by_one<Dim>(method.kernel(), sites, scene.stencils, derivatives);
  on_every_path([&] {
    const Weights found = method.weights(sites, scene.stencils, derivatives);
    ASSERT_EQ(found.columns, expected.columns);
    for (int p = 0; p < found.size(); ++p) {
      for (int d = 0; d < derivatives.size(); ++d) {
        const double size = expected.row(p).row(d).cwiseAbs().maxCoeff();
        EXPECT_LE((found.row(p).row(d) - expected.row(p).row(d)).cwiseAbs().maxCoeff(),
                  tolerance * size)
            << "point " << p << ' ' << name_of<Dim>(derivatives[d]);
      }
    }
  });
}

TEST(TaylorBatch, MatchesFitsMadeOneByOneOnEveryPath) {
  for (const char* cloud : {"grid", "perturbed[amount=0.3]"}) {
    for (int order = 1; order <= 4; ++order) {
      matches_fits<1>(fmt::format("lsfdm[order={}]", order), order, cloud);
      matches_fits<2>(fmt::format("lsfdm[order={}]", order), order, cloud);
    }
    for (int order = 1; order <= 3; ++order) {
      matches_fits<3>(fmt::format("lsfdm[order={}]", order), order, cloud);
    }
    for (const char* weight : {"volume", "cubic_spline", "quartic_spline", "inverse_cube", "power",
                               "power[p=3]", "power[p=2.5]"}) {
      matches_fits<2>(fmt::format("gfdm[weight={}]", weight), 2, cloud);
    }
  }
}

/// The same stencils, whose nodes come nearer to a line from left to right: up to a thousandth of
/// their heights.
Sites<2> squeezed(Sites<2> sites) {
  for (Points<2>* places : {&sites.nodes, &sites.anchors, &sites.points}) {
    for (int i = 0; i < places->cols(); ++i) (*places)(1, i) *= std::pow(1e-3, (*places)(0, i));
  }
  return sites;
}

/// Stencils sorted anew by distance.
Stencils sorted_again(const Sites<2>& sites, const Stencils& stencils) {
  Stencils sorted;
  for (int a = 0; a < stencils.size(); ++a) {
    std::vector<int> nodes(stencils[a].begin(), stencils[a].end());
    const auto distance = [&](int node) {
      return (sites.nodes.col(node) - sites.anchors.col(a)).squaredNorm();
    };
    std::sort(nodes.begin(), nodes.end(), [&](int i, int j) { return distance(i) < distance(j); });
    sorted.push_back(nodes);
  }
  return sorted;
}

/// Lanes of one group are clear of all limits, refined, or left to the orthogonal factorisation;
/// were one taken for a better one, it would lose up to eight digits.
void keeps_digits_when_squeezed(const std::string& spec) {
  SCOPED_TRACE(spec);
  const auto scene = make_scene<2>(spec, "perturbed[amount=0.3]", 20, 1);
  const auto& method = dynamic_cast<const TaylorMethod<2>&>(*scene.method);
  const Sites<2> sites = squeezed(scene.sites);
  const Stencils stencils = sorted_again(sites, scene.stencils);
  const std::vector<double> condition =
      method.condition(sites, sites.wanted_anchors(), stencils, Scaling::both, ConditionNorm::one);
  EXPECT_LT(*std::min_element(condition.begin(), condition.end()), 1e3);
  EXPECT_GT(*std::max_element(condition.begin(), condition.end()), 1e9);
  const auto derivatives = Derivatives<2>::between_orders(1, 2);
  const Weights expected = weights_one_by_one<2>(method.kernel(), sites, stencils, derivatives);
  on_every_path([&] {
    const Weights found = method.weights(sites, stencils, derivatives);
    for (int p = 0; p < found.size(); ++p) {
      for (int d = 0; d < derivatives.size(); ++d) {
        const double size = expected.row(p).row(d).cwiseAbs().maxCoeff();
        EXPECT_LE((found.row(p).row(d) - expected.row(p).row(d)).cwiseAbs().maxCoeff(),
                  tolerance * size)
            << "point " << p << ' ' << name_of<2>(derivatives[d]) << ", " << condition[p];
      }
    }
  });
}

TEST(TaylorBatch, KeepsDigitsWhateverTheConditionsInAGroup) {
  keeps_digits_when_squeezed("mfpm");
  keeps_digits_when_squeezed("lsfdm");
}

/// Stencils of every `stride`-th anchor only; the others are left empty.
Stencils every(const Stencils& stencils, int stride) {
  Stencils chosen;
  for (int a = 0; a < stencils.size(); ++a) {
    chosen.push_back(a % stride == 0 ? stencils[a] : std::span<const int>{});
  }
  return chosen;
}

TEST(TaylorBatch, GivesAnAnchorTheSameBitsInAnyCompany) {
  const auto scene = make_scene<2>("gfdm", "perturbed[amount=0.3]", 20, 1);
  const auto derivatives = Derivatives<2>::between_orders(1, 2);
  const Sites<2> sites = with_points_between<2>(scene.sites, 0.1);
  on_every_path([&] {
    const Weights all = scene.method->weights(sites, scene.stencils, derivatives);
    for (int stride : {2, 3, 7}) {
      const Weights some = scene.method->weights(sites, every(scene.stencils, stride), derivatives);
      for (int p = 0; p < some.size(); ++p) {
        if (some.nodes(p).empty()) continue;
        EXPECT_TRUE((some.row(p).array() == all.row(p).array()).all()) << p;
      }
    }
  });
}

/// The level makes rows of as many weights as are streamed, half of them fewer.
template <int Dim>
void writes_the_same_past_the_caches(int level) {
  SCOPED_TRACE(Dim);
  const auto scene = make_scene<Dim>("gfdm", "perturbed[amount=0.3]", level, 1);
  const auto derivatives = Derivatives<Dim>::between_orders(1, 2);
  const Stencils half = every(scene.stencils, 2);
  on_every_path([&] {
    const Weights all = scene.method->weights(scene.sites, scene.stencils, derivatives);
    const Weights some = scene.method->weights(scene.sites, half, derivatives);
    ASSERT_GE(all.values.size(), least_streamed);
    ASSERT_LT(some.values.size(), least_streamed);
    int others = 0;
    for (int p = 0; p < some.size(); p += 2) {
      others += (some.row(p).array() == all.row(p).array()).all() ? 0 : 1;
    }
    EXPECT_EQ(others, 0);
  });
}

TEST(TaylorBatch, WritesTheSameBitsPastTheCaches) {
  writes_the_same_past_the_caches<2>(230);
  writes_the_same_past_the_caches<3>(25);  // results of a group fill more than a page
}

TEST(TaylorBatch, GivesTheSameBitsOnAnyNumberOfThreads) {
  const auto scene = make_scene<2>("lsfdm", "perturbed[amount=0.3]", 30, 1);
  const auto derivatives = Derivatives<2>::between_orders(1, 2);
  omp_set_num_threads(1);
  const Weights one = scene.method->weights(scene.sites, scene.stencils, derivatives);
  omp_set_num_threads(3);
  const Weights three = scene.method->weights(scene.sites, scene.stencils, derivatives);
  omp_set_num_threads(1);
  EXPECT_EQ(one.values, three.values);
}

template <int Dim>
void decides_as_exact_conditions(const std::string& spec) {
  SCOPED_TRACE(spec);
  const auto scene = make_scene<Dim>(spec, "perturbed[amount=0.4]", Dim == 2 ? 20 : 9, 1);
  const std::vector<int> anchors = scene.sites.wanted_anchors();
  for (Scaling scaling : {Scaling::both, Scaling::row}) {
    for (ConditionNorm norm : {ConditionNorm::one, ConditionNorm::two}) {
      const std::vector<double> exact =
          scene.method->condition(scene.sites, anchors, scene.stencils, scaling, norm);
      for (double limit : {30.0, 100.0, 1e3, 1e5, 1e7}) {
        on_every_path([&] {
          const auto exceeds = scene.method->exceeds_condition(scene.sites, anchors, scene.stencils,
                                                               scaling, norm, limit);
          for (std::size_t i = 0; i < exact.size(); ++i) {
            EXPECT_EQ(exceeds[i] != 0, !(exact[i] <= limit)) << exact[i] << " against " << limit;
          }
        });
      }
    }
  }
}

TEST(TaylorBatch, DecidesConditionsAsExactOnesDo) {
  decides_as_exact_conditions<2>("mfpm");
  decides_as_exact_conditions<2>("gfdm[weight=cubic_spline]");
  decides_as_exact_conditions<3>("mfpm");
}

TEST(TaylorBatch, KeepsTheErrorsOfDegenerateStencils) {
  Points<2> nodes(2, 12);
  for (int i = 0; i < 12; ++i) nodes.col(i) = Point<2>(i, 0);  // on a line
  const Sites<2> sites = sites_at_nodes<2>(nodes);
  const Stencils stencils = make_search<2>("brute", nodes)->nearest(nodes, 9, Ties::keep);
  const auto method = make_method<2>("lsfdm").made;
  on_every_path([&] {
    try {
      method->weights(sites, stencils, {{1, 0}});
      ADD_FAILURE() << "nodes on a line pass";
    } catch (const CaseError& error) {
      EXPECT_NE(std::string(error.what()).find("degenerate"), std::string::npos) << error.what();
    }
  });
}

}  // namespace
}  // namespace strongpoint
