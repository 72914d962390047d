// Polyharmonic weights computed side by side, on each path, against those made one by one.
#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <omp.h>

#include "methods/core/polyharmonic.hpp"
#include "methods/core/simd/path.hpp"
#include "methods/core/spans.hpp"
#include "tests/contract_support.hpp"
#include "tests/simd_paths.hpp"

namespace strongpoint {
namespace {

template <int Dim>
struct Batch {
  Weights weights;
  std::vector<LocalOutcome> outcomes;  ///< of the anchors asked for
};

/// Weights of some anchors, handed to the kernel in groups of a size.
template <int Dim>
Batch<Dim> fill(const PolyharmonicFit<Dim>& fit, const Sites<Dim>& sites, const Stencils& stencils,
                const Derivatives<Dim>& derivatives, const std::vector<int>& anchors,
                std::size_t group) {
  Batch<Dim> made{weights_on_stencils<Dim>(sites, stencils, derivatives.size()),
                  std::vector<LocalOutcome>(anchors.size(), LocalOutcome::undecided)};
  const Stencils points = points_by_anchor<Dim>(sites);
  typename PolyharmonicFit<Dim>::Workspace work;
  for (std::size_t begin = 0; begin < anchors.size(); begin += group) {
    const std::size_t size = std::min(group, anchors.size() - begin);
    fit.fill_batch({sites, stencils, points, derivatives, {anchors.data() + begin, size}}, work,
                   made.weights, {made.outcomes.data() + begin, size});
  }
  return made;
}

/// Moves the evaluation points off the anchors: anchor a has a % 4 of them.
template <int Dim>
void scatter_points(Sites<Dim>& sites, double spacing) {
  sites.point_anchor.clear();
  for (int a = 0; a < sites.anchor_count(); ++a)
    sites.point_anchor.insert(sites.point_anchor.end(), a % 4, a);
  sites.points.resize(Dim, static_cast<Eigen::Index>(sites.point_anchor.size()));
  for (int p = 0; p < sites.point_count(); ++p) {
    const Point<Dim> direction = Point<Dim>::Constant(0.3).array() + 0.1 * (p % 5);
    sites.points.col(p) = sites.anchors.col(sites.point_anchor[p]) + spacing * direction;
  }
}

/// The stencils of some anchors alone.
Stencils stencils_of(const Stencils& stencils, const std::vector<int>& anchors) {
  Stencils chosen;
  for (int a : anchors) chosen.push_back(stencils[a]);
  return chosen;
}

/// Every path against the kernel one by one, within round-off times the condition of the bordered
/// matrix (1-norm); all stencils must be served.
template <int Dim>
void matches_one_by_one(int phs, int degree, bool at_anchors) {
  SCOPED_TRACE(fmt::format("{}D phs={} degree={}", Dim, phs, degree));
  const std::string spec = fmt::format("rbf_fd[phs={},degree={}]", phs, degree);
  const int level = test_level<Dim>(degree);
  TestScene<Dim> scene = make_scene<Dim>(spec, "perturbed", level, 3);
  Sites<Dim>& sites = scene.sites;
  if (!at_anchors) scatter_points<Dim>(sites, 1.0 / level);
  const PolyharmonicFit<Dim> fit(phs, degree);
  const auto derivatives = Derivatives<Dim>::between_orders(0, std::min({2, degree, phs - 1}));
  const std::vector<int> anchors = scene.stencils.occupied();
  const Stencils points = points_by_anchor<Dim>(sites);
  const auto conditions = scene.method->condition(
      sites, anchors, stencils_of(scene.stencils, anchors), Scaling::both, ConditionNorm::one);
  on_every_path([&] {
    const Batch<Dim> made = fill<Dim>(fit, sites, scene.stencils, derivatives, anchors, 64);
    typename PolyharmonicFit<Dim>::Workspace work;
    LocalStencil<Dim> local;
    for (std::size_t i = 0; i < anchors.size(); ++i) {
      ASSERT_EQ(made.outcomes[i], LocalOutcome::ok);
      ASSERT_EQ(local.gather(sites, scene.stencils[anchors[i]], anchors[i]), LocalOutcome::ok);
      ASSERT_EQ(fit.factorise(local, work), LocalOutcome::ok);
      const double tolerance = std::numeric_limits<double>::epsilon() * conditions[i];
      for (int p : points[anchors[i]]) {
        const Point<Dim> offset =
            (sites.points.col(p) - sites.anchors.col(anchors[i])) / local.radius;
        Eigen::MatrixXd one(derivatives.size(), local.size);
        fit.evaluate(local, work, offset, derivatives, {one.data(), one.rows(), one.cols()});
        for (int d = 0; d < derivatives.size(); ++d) {
          const double unit = std::pow(local.radius, order_of<Dim>(derivatives[d]));
          const double difference = (unit * made.weights.row(p).row(d) - one.row(d)).norm();
          EXPECT_LE(difference, tolerance * one.row(d).norm()) << p << ' ' << d;
        }
      }
    }
  });
}

TEST(PolyharmonicBatch, MatchesWeightsMadeOneByOne) {
  matches_one_by_one<1>(3, 4, true);
  matches_one_by_one<2>(1, 0, true);
  matches_one_by_one<2>(1, 2, true);
  matches_one_by_one<2>(3, 2, true);
  matches_one_by_one<2>(3, 4, true);
  matches_one_by_one<2>(5, 6, true);
  matches_one_by_one<2>(11, 5, true);
  matches_one_by_one<2>(3, 8, true);
  matches_one_by_one<3>(3, 2, true);
  matches_one_by_one<3>(5, 3, true);
}

TEST(PolyharmonicBatch, MatchesThemAtAnyNumberOfPointsOffTheAnchors) {
  matches_one_by_one<2>(3, 2, false);
  matches_one_by_one<2>(5, 4, false);
  matches_one_by_one<3>(3, 2, false);
}

/// A scene with points off the anchors that have spans, all but a few.
template <int Dim>
TestScene<Dim> scene_with_spans(const std::string& spec, int level) {
  TestScene<Dim> scene = make_scene<Dim>(spec, "perturbed", level, 3);
  Sites<Dim>& sites = scene.sites;
  scatter_points<Dim>(sites, 1.0 / level);
  sites.spans.resize(Dim, sites.point_count());
  for (int p = 0; p < sites.point_count(); ++p) {
    sites.spans.col(p) = Point<Dim>::Constant(0.06 / level) * (p % 7);
    sites.spans(0, p) *= -2;
  }
  return scene;
}

/// The means of weights at both ends of the spans, computed end by end.
template <int Dim>
Weights means_of_ends(const TestScene<Dim>& scene, const Derivatives<Dim>& derivatives) {
  Sites<Dim> end = scene.sites;
  end.spans.resize(Dim, 0);
  end.points += scene.sites.spans;
  Weights weights = scene.method->weights(end, scene.stencils, derivatives);
  end.points -= 2 * scene.sites.spans;
  const Weights others = scene.method->weights(end, scene.stencils, derivatives);
  for (std::size_t i = 0; i < weights.values.size(); ++i) {
    weights.values[i] = 0.5 * (weights.values[i] + others.values[i]);
  }
  return weights;
}

template <int Dim>
void averages_over_spans(const std::string& spec, int level, double tolerance) {
  SCOPED_TRACE(fmt::format("{}D {}", Dim, spec));
  const TestScene<Dim> scene = scene_with_spans<Dim>(spec, level);
  const auto derivatives = Derivatives<Dim>::between_orders(0, 2);
  on_every_path([&] {
    const Weights expected = means_of_ends<Dim>(scene, derivatives);
    const Weights found = weights_on<Dim>(*scene.method, scene.sites, scene.stencils, derivatives);
    ASSERT_EQ(found.columns, expected.columns);
    for (int p = 0; p < found.size(); ++p) {
      for (int d = 0; d < derivatives.size(); ++d) {
        EXPECT_LE((found.row(p).row(d) - expected.row(p).row(d)).norm(),
                  tolerance * expected.row(p).row(d).norm())
            << p << ' ' << d;
      }
    }
  });
}

TEST(PolyharmonicBatch, AveragesOverTheSpansOfPoints) {
  constexpr double round_off = 1e-9;  // conditions up to 1e5 of weights that cancel in the mean
  averages_over_spans<2>("rbf_fd", 12, round_off);
  averages_over_spans<2>("rbf_fd[phs=5,degree=4]", 12, round_off);
  averages_over_spans<3>("rbf_fd", 6, round_off);
  averages_over_spans<2>("lsfdm", 12, round_off);  // end by end
  averages_over_spans<2>("zoned", 12, round_off);
}

/// Nodes so close to a circle that squares of coordinates are nearly dependent.
TEST(PolyharmonicBatch, AveragesOneByOneWhatItLeavesUndecided) {
  constexpr double round_off = 1e-14;  // one by one both ways, but for the order of the mean
  constexpr int count = 12;
  TestScene<2> scene;
  scene.method = make_method<2>("rbf_fd").made;
  Points<2> nodes(2, count);
  std::vector<int> all(count);
  for (int i = 0; i < count; ++i) {
    nodes.col(i) = (1 + 1e-9 * (i % 5)) * Point<2>(std::cos(0.5 * i), std::sin(0.5 * i));
    all[i] = i;
  }
  scene.sites = sites_at_nodes<2>(nodes);
  for (int a = 0; a < count; ++a) scene.stencils.push_back(a == 0 ? all : std::vector<int>{});
  scene.sites.spans = Points<2>::Constant(2, count, 0.1);
  const Derivatives<2> derivatives = Derivatives<2>::between_orders(1, 1);
  const auto batch =
      fill<2>(PolyharmonicFit<2>(3, 2), scene.sites, scene.stencils, derivatives, {0}, 64);
  ASSERT_EQ(batch.outcomes[0], LocalOutcome::undecided);
  const Weights found = weights_on<2>(*scene.method, scene.sites, scene.stencils, derivatives);
  const Weights expected = means_of_ends<2>(scene, derivatives);
  EXPECT_LE((found.row(0) - expected.row(0)).norm(), round_off * expected.row(0).norm());
}

TEST(PolyharmonicBatch, GivesTheSameBitsInAnyCompany) {
  const auto scene = make_scene<2>("rbf_fd[degree=3]", "perturbed", 12, 1);
  const PolyharmonicFit<2> fit(3, 3);
  const auto derivatives = Derivatives<2>::between_orders(1, 2);
  std::vector<int> anchors = scene.stencils.occupied();
  on_every_path([&] {
    std::sort(anchors.begin(), anchors.end());
    const auto together = fill<2>(fit, scene.sites, scene.stencils, derivatives, anchors, 64);
    std::reverse(anchors.begin(), anchors.end());
    for (const std::size_t group : {1, 5}) {
      const auto apart = fill<2>(fit, scene.sites, scene.stencils, derivatives, anchors, group);
      EXPECT_EQ(together.weights.values, apart.weights.values);
    }
    for (const int threads : {1, 3}) {
      const int before = omp_get_max_threads();
      omp_set_num_threads(threads);
      const Weights weights = scene.method->weights(scene.sites, scene.stencils, derivatives);
      omp_set_num_threads(before);
      EXPECT_EQ(together.weights.values, weights.values) << threads;
    }
  });
}

TEST(PolyharmonicBatch, LeavesStencilsThatAreNotSafeUndecided) {
  // Anchors: nodes on a line, on a block of two rows with two at one place, too few, and well
  // spread ones.
  Points<2> nodes(2, 40);
  for (int i = 0; i < 10; ++i) nodes.col(i) = Point<2>(0.1 * i, 0);
  for (int i = 10; i < 40; ++i) {
    const int column = i % 5, row = i / 5;
    nodes.col(i) = Point<2>(3 + column + 0.1 * std::sin(i), row + 0.1 * std::cos(2 * i));
  }
  nodes.col(39) = nodes.col(38);
  const Sites<2> sites = sites_at_nodes<2>(nodes);
  Stencils stencils;
  for (int a = 0; a < 40; ++a) {
    std::vector<int> stencil;
    if (a == 0) stencil = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9};
    if (a == 10) stencil = {10, 11, 15, 16, 12};
    if (a == 20) stencil = {20, 21, 15, 25, 16, 26, 22, 10, 30, 11, 31};
    if (a == 38) stencil = {38, 39, 33, 37, 32, 28, 34, 27, 36, 29, 31};
    stencils.push_back(stencil);
  }
  const PolyharmonicFit<2> fit(3, 2);
  const std::vector<int> anchors{0, 10, 20, 38};
  on_every_path([&] {
    const auto made = fill<2>(fit, sites, stencils, {{1, 0}}, anchors, 64);
    const std::vector<LocalOutcome> expected{LocalOutcome::undecided, LocalOutcome::undecided,
                                             LocalOutcome::ok, LocalOutcome::undecided};
    EXPECT_EQ(made.outcomes, expected);
  });
}

}  // namespace
}  // namespace strongpoint
