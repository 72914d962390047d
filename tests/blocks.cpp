// Blocks of mapped domains: their nodes, differences in their coordinates, and what is solved on
// them: the figures of high-order blocks on the plate.
#include "problems/core/blocks.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "methods/core/rule.hpp"
#include "problems/core/gauss_legendre.hpp"
#include "problems/core/layout.hpp"
#include "tests/steady_cases.hpp"

namespace strongpoint {
namespace {

using Point2 = Point<2>;

constexpr double round_off = 1e-14;
constexpr const char* spectral = "fdm[order=spectral,exact=mapped]";

const Domain<2>& plate() {
  static const NamedProblem named = make_problem("plate_hole");
  return std::get<1>(named.made)->domain();
}

PointCloud<2> plate_cloud(const std::string& cloud, int level) {
  return make_cloud<2>(plate(), cloud, LayoutRequest{level, 1});
}

TEST(Blocks, GaussLobattoRulesAreThoseOfTheTables) {
  const LineRule four = gauss_lobatto(4);
  EXPECT_NEAR(four.at[1], (1 - std::sqrt(0.2)) / 2, round_off);
  EXPECT_NEAR(four.weight[0], 1.0 / 12, round_off);
  EXPECT_NEAR(four.weight[2], 5.0 / 12, round_off);
  const LineRule five = gauss_lobatto(5);
  EXPECT_NEAR(five.at[3], (1 + std::sqrt(3.0 / 7)) / 2, round_off);
  EXPECT_NEAR(five.weight[2], 16.0 / 45, round_off);
  for (int n = 2; n <= 24; ++n) {
    const LineRule rule = gauss_lobatto(n);
    for (int degree = 0; degree <= 2 * n - 3; ++degree) {
      double sum = 0;
      for (int i = 0; i < n; ++i) sum += rule.weight[i] * std::pow(rule.at[i], degree);
      EXPECT_NEAR(sum, 1.0 / (degree + 1), round_off) << n << " points, degree " << degree;
    }
  }
}

TEST(Blocks, LinesAreSymmetricAndEndExactly) {
  for (const BlockNodes nodes :
       {BlockNodes::uniform, BlockNodes::clustered, BlockNodes::chebyshev, BlockNodes::gll}) {
    for (const int n : {2, 3, 8, 21}) {
      const std::vector<double> axis = block_axis(nodes, n);
      EXPECT_EQ(axis.front(), 0);
      EXPECT_EQ(axis.back(), 1);
      EXPECT_TRUE(std::is_sorted(axis.begin(), axis.end()));
      for (int i = 0; i < n; ++i) EXPECT_NEAR(axis[i] + axis[n - 1 - i], 1, round_off);
    }
  }
  const double expected = std::asin(0.9 * std::cos(0.3 * std::numbers::pi)) / std::asin(0.9);
  EXPECT_NEAR(block_axis(BlockNodes::clustered, 11)[7], (1 + expected) / 2, round_off);
}

/// Against the polar map's derivatives in closed form.
TEST(Blocks, JacobiansOfSmoothMapsAreExact) {
  constexpr double tolerance = 1e-12;
  const auto map = [](const Point2& unit) -> Point2 {
    return std::exp(unit[1]) * Point2(std::cos(2 * unit[0]), std::sin(2 * unit[0]));
  };
  for (const Point2& unit : {Point2(0, 0), Point2(1, 1), Point2(0.4, 0.9)}) {
    const Eigen::Matrix2d computed = jacobian<2>(map, unit);
    const double r = std::exp(unit[1]);
    EXPECT_NEAR(computed(0, 0), -2 * r * std::sin(2 * unit[0]), tolerance);
    EXPECT_NEAR(computed(1, 0), 2 * r * std::cos(2 * unit[0]), tolerance);
    EXPECT_NEAR(computed(0, 1), r * std::cos(2 * unit[0]), tolerance);
    EXPECT_NEAR(computed(1, 1), r * std::sin(2 * unit[0]), tolerance);
  }
}

TEST(Blocks, OfThePlateMeetAlongTheDiagonalAndWhereTheyAreSplit) {
  const PointCloud<2> two = plate_cloud("blocks[nodes=chebyshev]", 6);
  ASSERT_EQ(two.parts.size(), 2U);
  for (int i = 0; i < two.size(); ++i) {
    const bool is_diagonal = std::abs(two.nodes(0, i) - two.nodes(1, i)) < round_off;
    EXPECT_EQ(two.twins_of(i).size(), is_diagonal ? 1U : 0U);
    if (!is_diagonal) continue;
    const Point2 normal = two.interfaces_of(i)[0].normal;
    const double sign = i < two.size() / 2 ? 1 : -1;
    EXPECT_LT((normal - sign * Point2(-1, 1) / std::sqrt(2)).norm(), 1e-12);
  }
  const PointCloud<2> many = plate_cloud("blocks[nodes=gll,split=2x3]", 5);
  EXPECT_EQ(many.parts.size(), 12U);
  int places = 0;
  for (int i = 0; i < many.size(); ++i) {
    const auto twins = many.twins_of(i);
    if (twins.empty() || i < twins[0]) ++places;
    for (int twin : twins) {
      EXPECT_LT((many.nodes.col(i) - many.nodes.col(twin)).norm(), round_off);
    }
  }
  EXPECT_EQ(places, (4 * 4 + 1) * (3 * 4 + 1));
}

TEST(Blocks, AreOneCloudWhereTheDomainHasOneBlock) {
  const UnitCube<3> cube;
  const PointCloud<3> cloud = make_cloud<3>(cube, "blocks[n=4,nodes=gll]", LayoutRequest{9, 1});
  EXPECT_TRUE(cloud.parts.empty());
  ASSERT_TRUE(cloud.block.has_value());
  EXPECT_EQ(cloud.block->axes[2], gauss_lobatto(4).at);
  EXPECT_EQ(cloud.size(), 64);
  EXPECT_EQ(cloud.marks_of(0).size(), 3U);
}

TEST(Blocks, AreCutIntoCellsThatShrinkTowardsTheEnds) {
  EXPECT_EQ(cell_ends(4, 1), (std::vector<double>{0, 0.25, 0.5, 0.75, 1}));
  const std::vector<double> ends = cell_ends(3, 0.25);
  EXPECT_NEAR(ends[1], 1.0 / 6, round_off);
  EXPECT_NEAR(ends[2], 5.0 / 6, round_off);
  EXPECT_EQ(ends[3], 1);
}

TEST(Blocks, RefuseSplitsThatAreNone) {
  for (const char* split : {"0", "x", "2x", "1x2x3", "-1", "1.5"}) {
    EXPECT_THROW(plate_cloud(std::string("blocks[split=") + split + "]", 5), UsageError) << split;
  }
}

/// Weights of all first and second derivatives on one block of the plate, applied to a function of
/// the block's coordinates.
template <class Function>
double largest_error(const std::string& method_spec, const std::string& cloud_spec, int level,
                     const Function& function) {
  const PointCloud<2> cloud = plate_cloud(cloud_spec, level);
  const auto method = make_method<2>(method_spec).made;
  const auto rule = make_rule<2>(method->default_stencil()).made;
  const Derivatives<2> all = Derivatives<2>::between_orders(1, 2);
  Sites<2> sites = sites_of_cloud<2>(cloud_of_part(cloud, 0));
  const auto search = make_search<2>("auto", sites.nodes);
  const Stencils stencils = select_stencils<2>(*rule, sites, *method, *search);
  const Weights weights = method->weights(sites, stencils, all);
  double worst = 0;
  for (int p = 0; p < weights.size(); ++p) {
    for (int d = 0; d < all.size(); ++d) {
      double sum = 0;
      const std::span<const int> nodes = weights.nodes(p);
      for (std::size_t j = 0; j < nodes.size(); ++j) {
        sum += weights.row(p)(d, static_cast<Eigen::Index>(j)) *
               function(Point2(sites.nodes.col(nodes[j])), MultiIndex<2>{});
      }
      worst = std::max(worst, std::abs(sum - function(Point2(sites.nodes.col(p)), all[d])));
    }
  }
  return worst;
}

/// ln r, the block's own coordinate but for a constant factor along each ray.
double logarithm(const Point2& x, const MultiIndex<2>& alpha) {
  const double r2 = x.squaredNorm();
  if (alpha == MultiIndex<2>{}) return std::log(r2) / 2;
  if (alpha[0] + alpha[1] == 1) return x[alpha[0] == 1 ? 0 : 1] / r2;
  if (alpha[0] == 1) return -2 * x[0] * x[1] / (r2 * r2);
  return (alpha[0] == 2 ? 1 : -1) * (x[1] * x[1] - x[0] * x[0]) / (r2 * r2);
}

double slope(const Point2& x, const MultiIndex<2>& alpha) {
  if (alpha == MultiIndex<2>{}) return 3 + 2 * x[0] - x[1];
  return alpha == MultiIndex<2>{1, 0} ? 2 : alpha == MultiIndex<2>{0, 1} ? -1 : 0;
}

TEST(MappedDifferences, AreExactForLinearFunctionsInSpace) {
  constexpr double tolerance = 1e-9;  // round-off of second derivatives at spacings of 0.003
  for (const char* method : {"fdm[order=2,exact=mapped]", "fdm[order=5,exact=mapped]", spectral}) {
    EXPECT_LT(largest_error(method, "blocks[nodes=clustered]", 9, slope), tolerance) << method;
  }
}

/// Second derivatives are met to one order less than first ones where lines are cut.
TEST(MappedDifferences, ConvergeAtTheirDegree) {
  for (const int degree : {2, 4, 6, 8}) {
    const std::string method = "fdm[exact=mapped,order=" + std::to_string(degree) + "]";
    const double coarse = largest_error(method, "blocks[nodes=clustered]", 21, logarithm);
    const double fine = largest_error(method, "blocks[nodes=clustered]", 41, logarithm);
    EXPECT_GT(std::log2(coarse / fine), degree - 1.3) << degree;
  }
  EXPECT_LT(largest_error(spectral, "blocks[nodes=chebyshev]", 24, logarithm), 1e-6);
}

TEST(MappedDifferences, SayWhatTheyCannotDo) {
  EXPECT_THROW(make_method<2>("fdm[order=spectral]"), UsageError);
  EXPECT_THROW(make_method<2>("fdm[order=17,exact=mapped]"), UsageError);
  EXPECT_THROW(make_method<2>("fdm[order=1,exact=mapped]"), UsageError);
  EXPECT_THROW(errors_of(steady_case("plate_hole", "fdm[order=8,exact=mapped]", "blocks", 6)),
               CaseError);
}

}  // namespace
}  // namespace strongpoint
