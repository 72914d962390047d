// Polynomial fits whose value is unknown side by side: each path against stencils one by one.
#include <algorithm>

#include <gtest/gtest.h>

#include "methods/core/moving_fit.hpp"
#include "methods/core/polynomial_fit.hpp"
#include "tests/batch_checks.hpp"

namespace strongpoint {
namespace {

/// Round-off of normal equations of condition up to 1e4, relative to the largest weight.
constexpr double round_off = 1e-11;

template <int Dim>
void match_one_by_one(const std::string& cloud, int level) {
  for (const char* spec : {"mls", "mls[degree=1]", "mls[kernel=cubic_spline]", "mls[kernel=gauss]",
                           "mls[derivatives=diffuse]", "rkpm"}) {
    matches_one_by_one<Dim, MovingFit<Dim>>(spec, cloud, 0, level, round_off);
  }
  for (const char* spec : {"gmls", "gmls[weight=volume]", "gmls[degree=3]", "mfpm_extended"}) {
    matches_one_by_one<Dim, PolynomialFit<Dim>>(spec, cloud, 0, level, round_off);
  }
}

TEST(MovingBatch, MatchesStencilsOneByOneOnEveryPath) {
  for (const char* cloud : {"grid", "perturbed[amount=0.2]"}) {
    match_one_by_one<1>(cloud, 15);
    match_one_by_one<2>(cloud, 9);
  }
  match_one_by_one<3>("perturbed[amount=0.2]", 6);
}

TEST(MovingBatch, GivesTheSameBitsInAnyCompany) {
  gives_same_bits_in_any_company<2, MovingFit<2>>("mls");
  gives_same_bits_in_any_company<3, MovingFit<3>>("rkpm");
  gives_same_bits_in_any_company<2, PolynomialFit<2>>("gmls");
}

TEST(MovingBatch, LeavesIllConditionedFitsToQr) {
  leaves_what_is_ill_conditioned<MovingFit<2>>("mls", 1e-3, 1e-10);
  leaves_what_is_ill_conditioned<PolynomialFit<2>>("gmls", 1e-3, 1e-10);
}

}  // namespace
}  // namespace strongpoint
