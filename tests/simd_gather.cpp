// Stencils gathered one a lane: each path against stencils gathered one by one.
#include <cmath>
#include <numbers>
#include <numeric>

#include <gtest/gtest.h>

#include "methods/core/local_stencil.hpp"
#include "methods/core/simd/gather_kernel.hpp"
#include "methods/core/simd/lane_array.hpp"
#include "tests/contract_support.hpp"

namespace strongpoint {
namespace {

constexpr double rounding = 1e-15;  // a few units in the last place of numbers up to 1

/// Runs a check on every path that the processor has.
template <class Check>
void on_every_path(Check check) {
  const SimdPath before = simd_path();
  for (SimdPath path : simd_paths()) {
    SCOPED_TRACE(name_of(path));
    use_simd_path(path);
    check(lanes_of(path));
  }
  use_simd_path(before);
}

struct Gathered {
  LaneArray z, rho;
  std::vector<double> radius;
  std::vector<unsigned> faulty;
};

template <int Dim>
Gathered gather(const Sites<Dim>& sites, const Stencils& stencils, const std::vector<int>& chosen,
                int size, int lanes) {
  const std::size_t groups = (chosen.size() + lanes - 1) / lanes;
  Gathered made{LaneArray(groups * lanes * size * Dim), LaneArray(groups * lanes * size),
                std::vector<double>(groups * lanes), std::vector<unsigned>(groups)};
  gather_stencils({{sites.nodes.data(), sites.anchors.data(), stencils.offsets.data(),
                    stencils.nodes.data(), chosen.data(), static_cast<int>(chosen.size()), size},
                   Dim,
                   made.z.data(),
                   made.rho.data(),
                   made.radius.data(),
                   made.faulty.data()});
  return made;
}

template <int Dim>
void matches_one_by_one() {
  const auto scene = make_scene<Dim>("gfdm[weight=one]", "perturbed", test_level<Dim>(2), 1);
  std::vector<int> chosen;
  int size = 0;
  for (int a = 0; a < scene.stencils.size(); a += 2) {
    chosen.push_back(a);
    size = std::max(size, static_cast<int>(scene.stencils[a].size()));
  }
  on_every_path([&](int lanes) {
    const Gathered made = gather<Dim>(scene.sites, scene.stencils, chosen, size, lanes);
    LocalStencil<Dim> one;
    for (std::size_t i = 0; i < chosen.size(); ++i) {
      ASSERT_EQ(one.gather(scene.sites, scene.stencils[chosen[i]], chosen[i]), LocalOutcome::ok);
      const std::size_t group = i / lanes;
      const std::size_t lane = i % lanes;
      EXPECT_NEAR(made.radius[i], one.radius, rounding);
      EXPECT_EQ(made.faulty[group], 0U);
      for (int j = 0; j < size; ++j) {
        const bool is_padding = j >= one.size;
        const std::size_t row = group * size + j;
        EXPECT_NEAR(made.rho[row * lanes + lane], is_padding ? 1 : one.rho[j], rounding);
        for (int c = 0; c < Dim; ++c) {
          EXPECT_NEAR(made.z[(row * Dim + c) * lanes + lane], is_padding ? 0 : one.node(j)[c],
                      rounding);
        }
      }
    }
  });
}

TEST(SimdGather, MatchesStencilsGatheredOneByOne) {
  matches_one_by_one<1>();
  matches_one_by_one<2>();
  matches_one_by_one<3>();
}

TEST(SimdGather, FindsTheLanesWithCoincidentNodesOnly) {
  Points<2> nodes(2, 12);
  for (int i = 0; i < 12; ++i) nodes.col(i) = Point<2>(i % 4, i / 4);
  nodes.col(7) = nodes.col(6) + Point<2>(1e-12, 0);
  const Sites<2> sites = sites_at_nodes<2>(nodes);
  const auto search = make_search<2>("brute", nodes);
  const Stencils stencils = search->nearest(nodes, 4, Ties::keep);
  std::vector<int> chosen(12);
  std::size_t size = 0;
  for (int a = 0; a < 12; ++a) {
    chosen[a] = a;
    size = std::max(size, stencils[a].size());
  }
  on_every_path([&](int lanes) {
    const Gathered made = gather<2>(sites, stencils, chosen, static_cast<int>(size), lanes);
    for (int a = 0; a < 12; ++a) {
      const std::span<const int> ids = stencils[a];
      const bool has_both =
          std::count(ids.begin(), ids.end(), 6) != 0 && std::count(ids.begin(), ids.end(), 7) != 0;
      EXPECT_EQ((made.faulty[a / lanes] >> (a % lanes) & 1U) != 0, has_both) << a;
    }
  });
}

/// Wheels side by side, the centres first: each has `spokes` nodes around it, all as far away; in
/// every other wheel two of them coincide.
struct Wheels {
  static constexpr int count = 16;
  Points<2> nodes;
  Stencils stencils;

  explicit Wheels(int spokes) : nodes(2, count * (spokes + 1)) {
    for (int wheel = 0; wheel < count; ++wheel) {
      nodes.col(wheel) = Point<2>(10 * wheel, 0);
      std::vector<int> stencil{wheel};
      for (int spoke = 0; spoke < spokes; ++spoke) {
        const int shown = wheel % 2 == 1 && spoke == spokes - 2 ? 3 : spoke;
        const double angle = 2 * std::numbers::pi * (shown + 0.01 * wheel) / spokes;
        stencil.push_back(count + wheel * spokes + spoke);
        nodes.col(stencil.back()) = nodes.col(wheel) + Point<2>(std::cos(angle), std::sin(angle));
      }
      stencils.push_back(stencil);
    }
    for (int other = count; other < nodes.cols(); ++other) stencils.push_back({});
  }
};

TEST(SimdGather, FindsCoincidentNodesAmongManyThatAreAsFarAway) {
  for (int spokes : {20, 100}) {
    const Wheels wheels(spokes);
    const Sites<2> sites = sites_at_nodes<2>(wheels.nodes);
    std::vector<int> chosen(Wheels::count);
    std::iota(chosen.begin(), chosen.end(), 0);
    on_every_path([&](int lanes) {
      const Gathered made = gather<2>(sites, wheels.stencils, chosen, spokes + 1, lanes);
      for (int wheel = 0; wheel < Wheels::count; ++wheel) {
        EXPECT_EQ(made.faulty[wheel / lanes] >> (wheel % lanes) & 1U, wheel % 2U)
            << wheel << " of " << spokes << " spokes";
      }
    });
  }
}

/// Nodes as far away that only one direction tells apart: the one in which the marks by which a
/// group is looked over do not change.
TEST(SimdGather, TellsNodesApartThatDifferInOneDirection) {
  Points<2> nodes(2, 16);
  nodes.setZero();
  const Point<2> along = Point<2>(0.7548776662466927, -1).normalized();
  const Point<2> across(-along[1], along[0]);
  for (int j = 1; j < 16; ++j) {
    const int pair = (j + 1) / 2;
    const double angle = 0.19 * pair;
    nodes.col(j) = (j % 2 == 1 ? -1 : 1) * std::sin(angle) * along + std::cos(angle) * across;
  }
  Stencils stencils;
  std::vector<int> all(16);
  std::iota(all.begin(), all.end(), 0);
  stencils.push_back(all);
  for (int other = 1; other < 16; ++other) stencils.push_back({});
  on_every_path([&](int lanes) {
    EXPECT_EQ(gather<2>(sites_at_nodes<2>(nodes), stencils, {0}, 16, lanes).faulty[0], 0U);
  });
}

}  // namespace
}  // namespace strongpoint
