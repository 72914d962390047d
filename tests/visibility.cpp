// Which places of a domain see each other, and the stencils that keep to it.
#include "problems/core/visibility.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>
#include <omp.h>

#include "methods/core/error.hpp"
#include "methods/core/registry.hpp"
#include "problems/core/layout.hpp"
#include "problems/core/problem.hpp"
#include "problems/core/random.hpp"
#include "studies/support/run_case.hpp"

namespace strongpoint {
namespace {

/// The unit square without the slit |x - 1/2| < width / 2, y > 1/2. Nodes of a grid that would lie
/// in the slit are its users' affair.
class SlitSquare final : public UnitCube<2> {
 public:
  explicit SlitSquare(double width) : half_(0.5 * width) {}
  double distance(const Point<2>& x) const override {
    // The slit's distance, as if it went on beyond the square.
    const Point<2> beyond(std::abs(x[0] - 0.5) - half_, 0.5 - x[1]);
    const double slit = beyond.cwiseMax(0).norm() + std::min(beyond.maxCoeff(), 0.0);
    return std::max(UnitCube<2>::distance(x), -slit);
  }
  /// The part [from, to] of the segment a + t (b - a) that is strictly within the slit, empty when
  /// from >= to. Source: Liang and Barsky 1984.
  std::pair<double, double> part_within(const Point<2>& a, const Point<2>& b) const {
    double from = 0;
    double to = 1;
    const Point<2> d = b - a;
    const auto clip = [&](double speed, double room) {  // speed * t < room
      if (speed > 0) to = std::min(to, room / speed);
      if (speed < 0) from = std::max(from, room / speed);
      if (speed == 0 && room <= 0) to = from;
    };
    clip(d[0], 0.5 + half_ - a[0]);
    clip(-d[0], a[0] - 0.5 + half_);
    clip(-d[1], a[1] - 0.5);
    return {from, to};
  }

 private:
  double half_;
};

Point<2> random_point(std::mt19937_64& generator) {
  const double x = uniform01(generator);
  return {x, uniform01(generator)};
}

TEST(Visibility, SegmentsThatCrossASlitOfAnyWidthAreBlocked) {
  std::mt19937_64 generator(5);
  for (const double width : {0.0, 1e-12, 1e-4, 0.01, 0.1}) {
    const SlitSquare domain(width);
    int blocked = 0;
    for (int i = 0; i < 4000; ++i) {
      const Point<2> a = random_point(generator);
      const Point<2> b = random_point(generator);
      if (domain.distance(a) > 0 || domain.distance(b) > 0) continue;
      // Below the slit's tip an end may look up past its corner.
      if (std::min(std::abs(a[0] - 0.5), std::abs(b[0] - 0.5)) < 0.5 * width) continue;
      if ((a[0] < 0.5) == (b[0] < 0.5)) {
        EXPECT_TRUE(sees<2>(domain, a, b)) << format_point(a) << format_point(b) << width;
        continue;
      }
      const double height = a[1] + (0.5 - a[0]) / (b[0] - a[0]) * (b[1] - a[1]);
      const double slope = std::abs((b[1] - a[1]) / (b[0] - a[0]));
      // Where the segment passes the slit's plane; corners that are cut are in doubt.
      const double margin = slope * (0.5 * width + 0.01 * (b - a).norm()) + 0.03 * (b - a).norm();
      if (std::abs(height - 0.5) < margin) continue;
      EXPECT_EQ(sees<2>(domain, a, b), height < 0.5)
          << format_point(a) << format_point(b) << " width " << width;
      blocked += height > 0.5 ? 1 : 0;
    }
    EXPECT_GT(blocked, 400);
  }
}

TEST(Visibility, NothingIsBlockedInAConvexDomain) {
  std::mt19937_64 generator(6);
  const UnitCube<3> cube;
  for (int i = 0; i < 20000; ++i) {
    Point<3> a, b;
    for (int c = 0; c < 3; ++c) {
      // Thirds of the coordinates at either face: many ends on edges and corners.
      a[c] = std::clamp(1.5 * uniform01(generator) - 0.25, 0.0, 1.0);
      b[c] = std::clamp(1.5 * uniform01(generator) - 0.25, 0.0, 1.0);
    }
    EXPECT_TRUE(sees<3>(cube, a, b)) << format_point(a) << format_point(b);
  }
}

TEST(Visibility, NodesOnOppositeFlanksOfASlitNeverSeeEachOther) {
  for (const double width : {1e-6, 1e-4, 0.01, 0.1}) {
    const SlitSquare domain(width);
    for (const double rise : {0.0, 0.02, 0.1, 0.3}) {
      const Point<2> left(0.5 - 0.5 * width, 0.6);
      const Point<2> right(0.5 + 0.5 * width, 0.6 + rise);
      EXPECT_FALSE(sees<2>(domain, left, right)) << width << ' ' << rise;
      EXPECT_FALSE(sees<2>(domain, right, left)) << width << ' ' << rise;
      // A flank sees along itself, and into its own side.
      EXPECT_TRUE(sees<2>(domain, left, Point<2>(left[0], 0.9))) << width;
      EXPECT_TRUE(sees<2>(domain, left, Point<2>(0.3, 0.7 + 0.5 * rise))) << width;
    }
  }
}

TEST(Visibility, ChordsOfAHoleAreSeenAlongUpToFourFifthsOfItsRadius) {
  const NamedProblem problem = make_problem("plate_hole[a=0.2]");
  const Domain<2>& domain = std::get<1>(problem.made)->domain();
  for (const double chord : {0.01, 0.1, 0.5, 0.75, 0.85, 1.2}) {
    const double angle = 2 * std::asin(0.5 * chord);
    const Point<2> a(0.2 * std::cos(0.1), 0.2 * std::sin(0.1));
    const Point<2> b(0.2 * std::cos(0.1 + angle), 0.2 * std::sin(0.1 + angle));
    EXPECT_EQ(sees<2>(domain, a, b), chord < 0.8) << chord;
  }
}

TEST(Visibility, NodesOfAFaceDoNotSeeAcrossTheMouthOfASlitInIt) {
  for (const double width : {0.0, 1e-9, 1e-4, 0.01, 0.1}) {
    const SlitSquare domain(width);
    for (const double reach : {0.06, 0.1, 0.2}) {
      EXPECT_FALSE(sees<2>(domain, Point<2>(0.5 - reach, 1), Point<2>(0.47 + reach, 1))) << width;
      EXPECT_TRUE(sees<2>(domain, Point<2>(0.5 - reach, 0), Point<2>(0.47 + reach, 0))) << width;
    }
  }
}

TEST(Visibility, PlacesOutsideStandForTheBoundaryNextToThem) {
  const SlitSquare domain(0.3);
  const Point<2> left(0.3, 0.8);
  const Point<2> right(0.7, 0.8);
  const Point<2> ghost(0.38, 0.75);  // of the left flank
  EXPECT_TRUE(sees<2>(domain, left, ghost));
  EXPECT_FALSE(sees<2>(domain, right, ghost));
  EXPECT_TRUE(sees<2>(domain, right, Point<2>(1.05, 0.9)));
  EXPECT_FALSE(sees<2>(domain, left, Point<2>(1.05, 0.9)));
}

/// A cloud of the slit square with stencils of a rule.
struct Slit {
  SlitSquare domain;
  PointCloud<2> cloud;
  Sites<2> sites;

  explicit Slit(double width, int level) : domain(width) {
    CloudBuilder<2> builder;
    for (int i = 0; i < level; ++i) {
      for (int j = 0; j < level; ++j) {
        const Point<2> x(static_cast<double>(i) / (level - 1),
                         static_cast<double>(j) / (level - 1));
        if (std::abs(x[0] - 0.5) > 0.5 * width || x[1] < 0.5) builder.add(x);
      }
    }
    for (int j = 0; j < level; ++j) {  // the flanks, between two columns of the grid
      const double y = static_cast<double>(j) / (level - 1);
      if (y < 0.5) continue;
      builder.add(Point<2>(0.5 - 0.5 * width, y));
      builder.add(Point<2>(0.5 + 0.5 * width, y));
    }
    cloud = builder.finish(1);
    sites = sites_at_nodes<2>(cloud.nodes);
    sites.sees = sight_in<2>(domain);
  }
  Stencils select(const std::string& rule) const {
    const auto search = make_search<2>("auto", sites.nodes);
    const auto method = make_method<2>("lsfdm").made;
    return select_stencils<2>(*make_rule<2>(rule).made, sites, *method, *search);
  }
};

TEST(VisibleRule, KeepsStencilsOnTheirSideOfASlitAndFull) {
  const Slit slit(0.01, 24);
  const Stencils base = slit.select("nearest");
  const Stencils seen = slit.select("visible");
  int across = 0;
  int changed = 0;
  for (int i = 0; i < base.size(); ++i) {
    const Point<2> x = slit.cloud.nodes.col(i);
    EXPECT_EQ(base[i].size(), seen[i].size());
    EXPECT_EQ(seen[i][0], i);
    for (int node : seen[i]) {
      const auto [from, to] = slit.domain.part_within(x, slit.cloud.nodes.col(node));
      EXPECT_LE((to - from) * (x - slit.cloud.nodes.col(node)).norm(), 1e-12)
          << format_point(x) << format_point(slit.cloud.nodes.col(node));
    }
    for (int node : base[i]) {
      across += x[1] > 0.6 && (x[0] < 0.5) != (slit.cloud.nodes(0, node) < 0.5) ? 1 : 0;
    }
    changed += std::equal(base[i].begin(), base[i].end(), seen[i].begin()) ? 0 : 1;
  }
  EXPECT_GT(across, 100) << "without the rule many stencils reach across";
  EXPECT_GT(changed, 40);
  EXPECT_LT(changed, base.size() / 4) << "only those at the slit change";
}

/// The field at the end of a crack, sqrt(r) sin(theta / 2) about the slit's tip with the cut along
/// the slit: smooth away from the tip in what is left of the square, opposite on both flanks.
double crack_field(const Point<2>& x) {
  const Point<2> from_tip = x - Point<2>(0.5, 0.5);
  const double angle = std::atan2(from_tip[0], -from_tip[1]);  // pi and -pi on the flanks
  return std::sqrt(from_tip.norm()) * std::sin(angle / 2);
}

TEST(VisibleRule, LetsDerivativesNextToASlitBeRight) {
  const Slit slit(0.01, 24);
  const auto method = make_method<2>("lsfdm").made;
  std::vector<double> worst;
  for (const char* rule : {"nearest", "visible"}) {
    const Weights weights = method->weights(slit.sites, slit.select(rule), {{1, 0}, {0, 1}});
    worst.push_back(0);
    for (int i = 0; i < slit.cloud.size(); ++i) {
      const Point<2> x = slit.cloud.nodes.col(i);
      const double radius = (x - Point<2>(0.5, 0.5)).norm();
      if (radius < 0.25) continue;
      Point<2> gradient = Point<2>::Zero();
      const auto row = weights.row(i);
      for (int j = 0; j < row.cols(); ++j) {
        gradient += row.col(j) * crack_field(slit.cloud.nodes.col(weights.nodes(i)[j]));
      }
      // The exact gradient has the length 1 / (2 sqrt(r)) everywhere.
      worst.back() = std::max(worst.back(), std::abs(gradient.norm() * 2 * std::sqrt(radius) - 1));
    }
  }
  EXPECT_GT(worst[0], 10) << "the jump across the slit over its width, some h / 4";
  EXPECT_LT(worst[1], 0.02) << "(h / r)^2 of second order";
}

TEST(VisibleRule, TakesTheNearestNodesThatAreSeen) {
  const Slit slit(0.01, 24);
  const Stencils seen = slit.select("visible[of=nearest[k=12,ties=cut]]");
  for (int i = 0; i < seen.size(); ++i) {
    const double reach = std::sqrt(squared_distance(slit.sites, i, seen[i].back()));
    int nearer = 0;
    for (int node = 0; node < slit.cloud.size(); ++node) {
      const double away = (slit.cloud.nodes.col(node) - slit.cloud.nodes.col(i)).norm();
      if (away > reach * (1 - tie_tolerance)) continue;
      nearer += sees<2>(slit.domain, slit.cloud.nodes.col(i), slit.cloud.nodes.col(node)) ? 1 : 0;
    }
    EXPECT_LE(nearer, 12);
    EXPECT_EQ(seen[i].size(), 12U);
  }
}

TEST(VisibleRule, IsTheSameOnAnyNumberOfThreads) {
  const Slit slit(0.01, 24);
  const Stencils one = slit.select("visible");
  omp_set_num_threads(4);
  const Stencils four = slit.select("visible");
  omp_set_num_threads(1);
  EXPECT_EQ(one.nodes, four.nodes);
}

TEST(VisibleRule, ChangesNothingOnAConvexDomain) {
  StageTimes times;
  CaseKey key{"poisson_cube", "lsfdm", "radius", "scattered", "collocation", "umfpack", 9};
  const NamedProblem problem = make_problem(key.problem);
  const auto& steady = dynamic_cast<const SteadyProblem<3>&>(*std::get<2>(problem.made));
  const auto base = discretise<3>(steady, key, RunOptions{}, times, Upto::stencils);
  key.stencil = "visible[of=radius]";
  const auto seen = discretise<3>(steady, key, RunOptions{}, times, Upto::stencils);
  EXPECT_EQ(base->stencils.nodes, seen->stencils.nodes);
  EXPECT_FALSE(seen->sites.sees) << "the scene may outlive the domain";
}

TEST(VisibleRule, NeverReachesAcrossTheHoleOfThePlate) {
  StageTimes times;
  const CaseKey key{"plate_hole[a=0.05]",
                    "lsfdm",
                    "zoned[boundary=visible]",
                    "scattered",
                    "collocation",
                    "umfpack",
                    5};
  const NamedProblem problem = make_problem(key.problem);
  const auto& steady = dynamic_cast<const SteadyProblem<2>&>(*std::get<1>(problem.made));
  const auto made = discretise<2>(steady, key, RunOptions{}, times, Upto::stencils);
  const Discretisation<2>& scene = *made;
  for (int i = 0; i < scene.cloud.size(); ++i) {
    if (!scene.cloud.is_boundary(i)) continue;
    for (int node : scene.stencils[i]) {
      EXPECT_TRUE(sees<2>(steady.domain(), scene.cloud.nodes.col(i), scene.cloud.nodes.col(node)));
    }
  }
}

TEST(VisibleRule, RefusesSitesWithoutSight) {
  Slit slit(0.01, 10);
  slit.sites.sees = nullptr;
  EXPECT_THROW(slit.select("visible"), std::logic_error);
}

}  // namespace
}  // namespace strongpoint
