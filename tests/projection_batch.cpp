// Projections of the Taylor series side by side: each path against stencils one by one.
#include <algorithm>

#include <gtest/gtest.h>

#include "methods/core/projection_fit.hpp"
#include "tests/batch_checks.hpp"

namespace strongpoint {
namespace {

/// Round-off of systems of condition up to 1e4, relative to the largest weight.
constexpr double round_off = 1e-11;

template <int Dim>
void match_one_by_one(const std::string& cloud, int level) {
  for (const char* spec : {"msph", "msph[kernel=cubic_spline]", "msph[kernel=quartic_spline,h=1.6]",
                           "msph[kernel=wendland]", "cspm", "cspm[value=kernel]"}) {
    matches_one_by_one<Dim, ProjectionFit<Dim>>(spec, cloud, 0, level, round_off);
  }
}

TEST(ProjectionBatch, MatchesStencilsOneByOneOnEveryPath) {
  for (const char* cloud : {"grid", "perturbed[amount=0.2]"}) {
    match_one_by_one<1>(cloud, 15);
    match_one_by_one<2>(cloud, 9);
  }
  match_one_by_one<3>("perturbed[amount=0.2]", 5);
}

TEST(ProjectionBatch, GivesTheSameBitsInAnyCompany) {
  gives_same_bits_in_any_company<2, ProjectionFit<2>>("msph");
  gives_same_bits_in_any_company<2, ProjectionFit<2>>("cspm[value=kernel]");
  gives_same_bits_in_any_company<3, ProjectionFit<3>>("cspm");
}

TEST(ProjectionBatch, LeavesIllConditionedSystemsToExchangesOfRows) {
  constexpr double larger_round_off = 1e-9;  // of conditions up to 1e6
  leaves_what_is_ill_conditioned<ProjectionFit<2>>("msph", 5e-3, larger_round_off);
  leaves_what_is_ill_conditioned<ProjectionFit<2>>("cspm", 5e-3, larger_round_off);
}

}  // namespace
}  // namespace strongpoint
