// The engines that search in groups, on every SIMD path, against brute force.
#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "methods/core/neighbours.hpp"
#include "methods/core/sanitizers.hpp"
#include "methods/core/simd/path.hpp"
#include "problems/core/random.hpp"
#include "tests/random_nodes.hpp"

namespace strongpoint {
namespace {

/// A cubic lattice, its nodes in random order: distances tie, exactly or but for round-off.
template <int Dim>
Points<Dim> lattice(double spacing) {
  const int side = Dim == 2 ? 32 : 10;
  const int count = static_cast<int>(std::lround(std::pow(side, Dim)));
  std::vector<int> order(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) order[i] = i;
  std::mt19937_64 generator(5);
  for (int i = count - 1; i > 0; --i) {
    std::swap(order[i], order[static_cast<int>(uniform01(generator) * (i + 1))]);
  }
  Points<Dim> nodes(Dim, count);
  for (int i = 0; i < count; ++i) {
    for (int c = 0, rest = order[i]; c < Dim; ++c, rest /= side)
      nodes(c, i) = rest % side * spacing;
  }
  return nodes;
}

/// Each node of a random cloud a second time.
template <int Dim>
Points<Dim> doubled() {
  const Points<Dim> once = random_nodes<Dim>(500, 23);
  Points<Dim> nodes(Dim, 1000);
  nodes << once, once;
  return nodes;
}

/// Clusters of sizes 1, 1e-3, 1e-6 and 0, far apart.
template <int Dim>
Points<Dim> clustered() {
  Points<Dim> nodes = random_nodes<Dim>(1000, 11);
  for (int i = 0; i < nodes.cols(); ++i) {
    const double size[] = {1, 1e-3, 1e-6, 0};
    nodes.col(i) = size[i % 4] * nodes.col(i) + Point<Dim>::Constant(20 * (i % 4));
  }
  return nodes;
}

template <int Dim>
std::vector<std::pair<std::string, Points<Dim>>> clouds() {
  Points<Dim> thin = random_nodes<Dim>(1000, 13);
  thin.bottomRows(1) *= 1e-5;
  Points<Dim> flat = random_nodes<Dim>(700, 29);
  flat.bottomRows(1).setConstant(0.25);
  const Points<Dim> graded = random_nodes<Dim>(1000, 7).array().pow(6).matrix();
  const Points<Dim> far = (1e-3 * random_nodes<Dim>(1000, 31).array() + 1e6).matrix();
  const Points<Dim> tiny = 1e-200 * random_nodes<Dim>(400, 37);
  const Points<Dim> same = Points<Dim>::Constant(Dim, 200, 0.5);
  return {{"random", random_nodes<Dim>(1200, 3)},
          {"few", random_nodes<Dim>(20, 3)},
          {"lattice of binary fractions", lattice<Dim>(0.125)},
          {"lattice with round-off", lattice<Dim>(0.1)},
          {"doubled", doubled<Dim>()},
          {"clustered", clustered<Dim>()},
          {"thin", thin},
          {"flat", flat},
          {"graded", graded},
          {"far from the origin", far},
          {"tiny", tiny},
          {"one place", same}};
}

/// All nodes, every third one, and places that are no nodes: inside, near by and far away.
template <int Dim>
std::vector<std::pair<std::string, Points<Dim>>> queries_for(const Points<Dim>& nodes) {
  std::vector<int> third;
  third.reserve(static_cast<std::size_t>(nodes.cols()));
  for (int i = 1; i < nodes.cols(); i += 3) third.push_back(i);
  const Point<Dim> low = nodes.rowwise().minCoeff();
  const Point<Dim> extent = nodes.rowwise().maxCoeff() - low;
  Points<Dim> free = random_nodes<Dim>(150, 41);
  for (int i = 0; i < free.cols(); ++i) {
    const double stretch = i < 100 ? 1 : i < 140 ? 3 : 1e4;
    free.col(i) = low + stretch * free.col(i).cwiseProduct(extent);
  }
  return {{"all nodes", nodes}, {"every third", columns_of<Dim>(nodes, third)}, {"free", free}};
}

class EveryPath : public testing::Test {
 protected:
  void TearDown() override { use_simd_path(before_); }

 private:
  SimdPath before_ = simd_path();
};

template <int Dim>
void expect_brute_force_results(int k, Ties ties) {
  for (const auto& [cloud, nodes] : clouds<Dim>()) {
    for (const auto& [which, queries] : queries_for<Dim>(nodes)) {
      const Stencils expected = make_search<Dim>("brute", nodes)->nearest(queries, k, ties);
      for (SimdPath path : simd_paths()) {
        use_simd_path(path);
        for (const char* engine : {"grid", "bucket"}) {
          SCOPED_TRACE(
              fmt::format("{} on {}, {}: {}, k = {}", engine, cloud, name_of(path), which, k));
          const Stencils found = make_search<Dim>(engine, nodes)->nearest(queries, k, ties);
          EXPECT_EQ(found.offsets, expected.offsets);
          EXPECT_EQ(found.nodes, expected.nodes);
        }
      }
    }
  }
}

/// Those sizes that are checked: two where a race is looked for, which no size of a stencil hides
/// and which takes twenty times longer.
std::vector<int> some_of(const std::vector<int>& sizes) {
  if (checks_threads) return {sizes[sizes.size() / 2], sizes.back()};
  return sizes;
}

// Sizes around those of the networks that sort 32, 64 and 128 nodes, and beyond them.
TEST_F(EveryPath, FindsWhatBruteForceFindsInThePlane) {
  for (int k : some_of({1, 6, 15, 31, 60, 96, 120})) expect_brute_force_results<2>(k, Ties::keep);
}

TEST_F(EveryPath, FindsWhatBruteForceFindsInSpace) {
  for (int k : some_of({1, 10, 30, 50, 96})) expect_brute_force_results<3>(k, Ties::keep);
}

TEST_F(EveryPath, CutsTiesByNodeId) {
  expect_brute_force_results<2>(15, Ties::cut);
  expect_brute_force_results<3>(30, Ties::cut);
}

TEST_F(EveryPath, FindsWhatBruteForceFindsWithinARadius) {
  for (const auto& [cloud, nodes] : clouds<2>()) {
    for (const auto& [which, queries] : queries_for<2>(nodes)) {
      const Stencils near = make_search<2>("brute", nodes)->nearest(queries, 12, Ties::cut);
      std::vector<double> radii;
      radii.reserve(static_cast<std::size_t>(queries.cols()));
      for (int q = 0; q < queries.cols(); ++q) {
        radii.push_back((queries.col(q) - nodes.col(near[q].back())).norm());
      }
      const Stencils expected = make_search<2>("brute", nodes)->within(queries, radii);
      for (const char* engine : {"grid", "bucket"}) {
        SCOPED_TRACE(fmt::format("{} on {}: {}", engine, cloud, which));
        const Stencils found = make_search<2>(engine, nodes)->within(queries, radii);
        EXPECT_EQ(found.offsets, expected.offsets);
        EXPECT_EQ(found.nodes, expected.nodes);
      }
    }
  }
}

}  // namespace
}  // namespace strongpoint
