#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "problems/core/point_cloud.hpp"
#include "problems/core/random.hpp"

namespace strongpoint {
namespace {

/// Random nodes of the unit square; every third has a mark that tells its number.
PointCloud<2> numbered_cloud(int count) {
  std::mt19937_64 generator(1);
  CloudBuilder<2> builder;
  for (int i = 0; i < count; ++i) {
    const Point<2> x(uniform01(generator), uniform01(generator));
    std::vector<BoundaryMark<2>> marks;
    if (i % 3 == 0) marks.push_back({i, Point<2>(1, 0)});
    builder.add(x, marks);
  }
  return builder.finish(1);
}

double mean_step(const PointCloud<2>& cloud) {
  double sum = 0;
  for (int i = 1; i < cloud.size(); ++i)
    sum += (cloud.nodes.col(i) - cloud.nodes.col(i - 1)).norm();
  return sum / (cloud.size() - 1);
}

TEST(NodeOrder, PutsNearNodesSideBySideAndKeepsTheirNumbersAndMarks) {
  constexpr int count = 2000;
  const PointCloud<2> given = numbered_cloud(count);
  const PointCloud<2> cloud = along_curve(given);
  ASSERT_EQ(cloud.size(), count);
  EXPECT_EQ(cloud.measure, given.measure);
  EXPECT_GT(mean_step(given), 0.4);  // 0.52 on average between random nodes
  EXPECT_LT(mean_step(cloud), 1.2 / std::sqrt(count));
  for (int i = 0; i < count; ++i) {
    const int number = cloud.number_of(i);
    EXPECT_EQ(cloud.nodes.col(i), given.nodes.col(number));
    ASSERT_EQ(cloud.marks_of(i).size(), number % 3 == 0 ? 1U : 0U);
    if (number % 3 == 0) {
      EXPECT_EQ(cloud.marks_of(i)[0].side, number);
    }
  }
}

TEST(NodeOrder, GivesResultsBackInTheOrderOfTheNumbers) {
  const PointCloud<2> given = numbered_cloud(500);
  const PointCloud<2> cloud = along_curve(given);
  EXPECT_EQ(in_given_order(cloud, Eigen::MatrixXd(cloud.nodes)), Eigen::MatrixXd(given.nodes));
  EXPECT_EQ(in_given_order(given, Eigen::MatrixXd(given.nodes)), Eigen::MatrixXd(given.nodes));
}

TEST(NodeOrder, NamesNodesByTheirNumbersHoweverOftenTheyMove) {
  const PointCloud<2> given = numbered_cloud(100);
  std::vector<int> back(100);
  for (int i = 0; i < 100; ++i) back[i] = 99 - i;
  const PointCloud<2> cloud = reordered(reordered(given, back), back);
  EXPECT_EQ(cloud.nodes, given.nodes);
  EXPECT_EQ(cloud.mark_offsets, given.mark_offsets);
  for (int i = 0; i < 100; ++i) EXPECT_EQ(cloud.number_of(i), i);
}

TEST(NodeOrder, LeavesStructuredCloudsAndPartsAsTheyAre) {
  PointCloud<2> structured = numbered_cloud(9);
  structured.block = IndexBlock<2>{{3, 3}};
  EXPECT_EQ(along_curve(structured).nodes, structured.nodes);
  EXPECT_TRUE(along_curve(structured).numbers.empty());
  PointCloud<2> parts = numbered_cloud(9);
  parts.parts = {{0, 9, 0, {}}};
  EXPECT_EQ(along_curve(parts).nodes, parts.nodes);
}

TEST(NodeOrder, IsKnownToTheSites) {
  const PointCloud<2> cloud = along_curve(numbered_cloud(50));
  const Sites<2> sites = sites_of_cloud(cloud);
  for (int i = 0; i < 50; ++i) EXPECT_EQ(sites.number_of(i), cloud.number_of(i));
  EXPECT_EQ(sites.number_of(50), 50);  // a ghost has no number of its own
}

}  // namespace
}  // namespace strongpoint
