#include "methods/core/neighbours.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <omp.h>

#include "methods/core/error.hpp"
#include "problems/core/random.hpp"
#include "tests/random_nodes.hpp"

namespace strongpoint {
namespace {

/// A grid whose spacing is no binary fraction: equal distances differ in round-off.
template <int Dim>
Points<Dim> grid_nodes() {
  const int side = Dim == 1 ? 200 : Dim == 2 ? 17 : 7;
  const int count = static_cast<int>(std::lround(std::pow(side, Dim)));
  Points<Dim> nodes(Dim, count);
  for (int i = 0; i < count; ++i) {
    for (int c = 0, rest = i; c < Dim; ++c, rest /= side) nodes(c, i) = (rest % side) * 0.1;
  }
  return nodes;
}

/// Nodes that crowd towards the origin: their distances span six orders of magnitude.
template <int Dim>
Points<Dim> graded_nodes() {
  Points<Dim> nodes = random_nodes<Dim>(300, 7);
  nodes = nodes.array().pow(6).matrix();
  return nodes;
}

/// Three tight clusters, one of coincident nodes, and a few nodes far away.
template <int Dim>
Points<Dim> clustered_nodes() {
  Points<Dim> nodes = random_nodes<Dim>(320, 11);
  for (int i = 0; i < 300; ++i) {
    const double size = i % 3 == 0 ? 1e-3 : i % 3 == 1 ? 1e-6 : 0;
    nodes.col(i) = size * nodes.col(i) + Point<Dim>::Constant(i % 3 - 1);
  }
  nodes.rightCols(20) *= 100;
  return nodes;
}

/// All nodes on one line: the bounding box has no thickness.
template <int Dim>
Points<Dim> line_nodes() {
  Points<Dim> nodes = random_nodes<Dim>(150, 13);
  nodes.bottomRows(Dim - 1).setConstant(0.25);
  return nodes;
}

template <int Dim>
std::vector<std::pair<std::string, Points<Dim>>> clouds() {
  return {{"random", random_nodes<Dim>(300, 3)}, {"grid", grid_nodes<Dim>()},
          {"graded", graded_nodes<Dim>()},       {"clustered", clustered_nodes<Dim>()},
          {"line", line_nodes<Dim>()},           {"one node", random_nodes<Dim>(1, 5)}};
}

/// The nodes themselves, positions between them and positions outside, near and far.
template <int Dim>
Points<Dim> queries_for(const Points<Dim>& nodes) {
  const Points<Dim> extra = random_nodes<Dim>(60, 17);
  Points<Dim> queries(Dim, nodes.cols() + extra.cols());
  queries << nodes, extra;
  const Eigen::Index n = nodes.cols();
  for (Eigen::Index i = 0; i < 20; ++i) {
    queries.col(n + i) = (nodes.col(i % n) + nodes.col((i + 1) % n)) / 2;
    queries.col(n + 20 + i) = 4 * extra.col(20 + i) - Point<Dim>::Constant(2);
  }
  queries.col(n + 59) *= 1e7;
  return queries;
}

/// All nodes sorted by (distance, node id), straight from the definition.
template <int Dim>
std::vector<std::pair<double, int>> sorted_nodes(const Points<Dim>& nodes, const Point<Dim>& x) {
  std::vector<std::pair<double, int>> all;
  for (int i = 0; i < static_cast<int>(nodes.cols()); ++i) {
    double sum = 0;
    for (int c = 0; c < Dim; ++c) sum += (x[c] - nodes(c, i)) * (x[c] - nodes(c, i));
    all.emplace_back(sum, i);
  }
  std::sort(all.begin(), all.end());
  return all;
}

template <int Dim>
Stencils expected_nearest(const Points<Dim>& nodes, const Points<Dim>& queries, int k, Ties ties) {
  Stencils result;
  for (Eigen::Index q = 0; q < queries.cols(); ++q) {
    const auto all = sorted_nodes<Dim>(nodes, queries.col(q));
    const std::size_t least = std::min<std::size_t>(k, all.size());
    std::vector<int> stencil;
    for (const auto& [d2, node] : all) {
      const bool tied = ties == Ties::keep &&
                        std::sqrt(d2) <= std::sqrt(all[least - 1].first) * (1 + tie_tolerance);
      if (stencil.size() < least || tied) stencil.push_back(node);
    }
    result.push_back(stencil);
  }
  return result;
}

void expect_same(const Stencils& got, const Stencils& expected) {
  EXPECT_EQ(got.offsets, expected.offsets);
  EXPECT_EQ(got.nodes, expected.nodes);
}

/// Calls `check<Dim>(engine name, cloud)` for every engine and cloud.
template <int Dim, class Check>
void for_each_engine_and_cloud(const Check& check) {
  for (const auto& [name, nodes] : clouds<Dim>()) {
    for (const std::string& engine : search_engines()) {
      SCOPED_TRACE(fmt::format("{} on {} in {}D", engine, name, Dim));
      check(engine, nodes);
    }
  }
}

template <class T>
class Neighbours : public testing::Test {};
using Dimensions = testing::Types<Dimension<1>, Dimension<2>, Dimension<3>>;
template <class T>
struct DimensionOf;
template <int Dim>
struct DimensionOf<Dimension<Dim>> {
  static constexpr int value = Dim;
};
TYPED_TEST_SUITE(Neighbours, Dimensions);

TYPED_TEST(Neighbours, NearestAgreesWithSortingAllNodes) {
  constexpr int Dim = DimensionOf<TypeParam>::value;
  for (const auto& [name, nodes] : clouds<Dim>()) {
    const Points<Dim> queries = queries_for<Dim>(nodes);
    for (int k : {1, 9, 15, 30, 1000}) {
      for (Ties ties : {Ties::keep, Ties::cut}) {
        const Stencils expected = expected_nearest<Dim>(nodes, queries, k, ties);
        for (const std::string& engine : search_engines()) {
          SCOPED_TRACE(fmt::format("{} on {}, k = {}, ties {}", engine, name, k,
                                   ties == Ties::keep ? "kept" : "cut"));
          expect_same(make_search<Dim>(engine, nodes)->nearest(queries, k, ties), expected);
        }
      }
    }
  }
}

TYPED_TEST(Neighbours, WithinAgreesWithSortingAllNodes) {
  constexpr int Dim = DimensionOf<TypeParam>::value;
  for_each_engine_and_cloud<Dim>([](const std::string& engine, const Points<Dim>& nodes) {
    const Points<Dim> queries = queries_for<Dim>(nodes);
    std::vector<double> radii;
    for (Eigen::Index q = 0; q < queries.cols(); ++q) {
      // Exactly the distance of some node, to see that the bound is included; nothing, or all.
      const auto all = sorted_nodes<Dim>(nodes, queries.col(q));
      const double to_some = std::sqrt(all[static_cast<std::size_t>(q) % all.size()].first);
      const double infinity = std::numeric_limits<double>::infinity();
      radii.push_back(q % 5 < 2 ? to_some : q % 5 == 2 ? 0 : q % 5 == 3 ? -1 : infinity);
    }
    Stencils expected;
    for (Eigen::Index q = 0; q < queries.cols(); ++q) {
      std::vector<int> stencil;
      for (const auto& [d2, node] : sorted_nodes<Dim>(nodes, queries.col(q))) {
        if (radii[q] >= 0 && d2 <= radii[q] * radii[q]) stencil.push_back(node);
      }
      expected.push_back(stencil);
    }
    expect_same(make_search<Dim>(engine, nodes)->within(queries, radii), expected);
  });
}

TYPED_TEST(Neighbours, OneAndFourThreadsAgree) {
  constexpr int Dim = DimensionOf<TypeParam>::value;
  const int before = omp_get_max_threads();
  const Points<Dim> nodes = random_nodes<Dim>(5000, 19);
  const std::vector<double> radii(5000, 0.05);
  for (const std::string& engine : search_engines()) {
    const auto search = make_search<Dim>(engine, nodes);
    omp_set_num_threads(1);
    const Stencils nearest = search->nearest(nodes, 15, Ties::keep);
    const Stencils within = search->within(nodes, radii);
    omp_set_num_threads(4);
    expect_same(search->nearest(nodes, 15, Ties::keep), nearest);
    expect_same(search->within(nodes, radii), within);
    EXPECT_EQ(nearest.size(), 5000);
  }
  omp_set_num_threads(before);
}

TYPED_TEST(Neighbours, AnEmptyCloudHasNoNeighbours) {
  constexpr int Dim = DimensionOf<TypeParam>::value;
  const Points<Dim> none(Dim, 0);
  const Points<Dim> queries = random_nodes<Dim>(3, 1);
  for (const std::string& engine : search_engines()) {
    const auto search = make_search<Dim>(engine, none);
    EXPECT_EQ(search->nearest(queries, 4, Ties::keep).offsets, (std::vector<std::int64_t>(4, 0)));
    EXPECT_EQ(search->nearest(none, 4, Ties::keep).size(), 0);
  }
}

TEST(NeighboursTies, AreKeptWithinTheToleranceAndCutByNodeId) {
  // Distances from 0: 1 + 1e-8 (beyond), 1 + 5e-10 (ties), 1, 0.5, and -1 exactly tied.
  Points<1> nodes(1, 5);
  nodes << 1 + 1e-8, 1 + 5e-10, 1.0, 0.5, -1.0;
  const Points<1> origin = Points<1>::Zero(1, 1);
  for (const std::string& engine : search_engines()) {
    const auto search = make_search<1>(engine, nodes);
    EXPECT_EQ(search->nearest(origin, 2, Ties::keep).nodes, (LargeArray<int>{3, 2, 4, 1}));
    EXPECT_EQ(search->nearest(origin, 2, Ties::cut).nodes, (LargeArray<int>{3, 2}));
    EXPECT_EQ(search->nearest(origin, 4, Ties::cut).nodes, (LargeArray<int>{3, 2, 4, 1}));
  }
}

TEST(NeighboursTies, KeepWholeRingsOfAGrid) {
  Points<3> nodes(3, 27);
  for (int i = 0; i < 27; ++i)
    nodes.col(i) = 0.1 * Eigen::Vector3i(i / 9, i / 3 % 3, i % 3).cast<double>();
  const Points<3> centre = nodes.col(13);
  for (const std::string& engine : search_engines()) {
    const auto search = make_search<3>(engine, nodes);
    for (const auto& [k, size] : {std::pair{1, 1}, {2, 7}, {7, 7}, {8, 19}, {20, 27}}) {
      EXPECT_EQ(search->nearest(centre, k, Ties::keep).nodes.size(), size) << engine << " " << k;
    }
  }
}

TEST(NeighboursErrors, NameWhatIsWrong) {
  Points<2> nodes = random_nodes<2>(10, 1);
  try {
    make_search<2>("octopus", nodes);
    FAIL() << "an unknown engine must not be accepted";
  } catch (const UsageError& error) {
    const std::string message = error.what();
    for (const char* word : {"octopus", "auto", "brute", "nanoflann", "grid"}) {
      EXPECT_NE(message.find(word), std::string::npos) << message;
    }
  }
  Points<2> bad = nodes;
  bad(1, 4) = std::numeric_limits<double>::quiet_NaN();
  for (const std::string& engine : search_engines()) {
    EXPECT_THROW(make_search<2>(engine, bad), CaseError);
    const auto search = make_search<2>(engine, nodes);
    EXPECT_THROW(search->nearest(bad, 3, Ties::keep), CaseError);
    EXPECT_THROW(search->within(nodes, std::vector<double>(10, NAN)), CaseError);
    EXPECT_THROW(search->within(nodes, std::vector<double>(9, 1.0)), std::invalid_argument);
    EXPECT_THROW(search->nearest(nodes, 0, Ties::keep), std::invalid_argument);
  }
}

TEST(NeighboursEngines, StartWithAuto) { EXPECT_EQ(search_engines().front(), "auto"); }

}  // namespace
}  // namespace strongpoint
