// Stencils gathered one a lane: each path against stencils gathered one by one.
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

}  // namespace
}  // namespace strongpoint
