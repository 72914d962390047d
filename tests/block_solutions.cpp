// What is solved on blocks: the recipes' figures on the plate, Cook's membrane, cubes.
#include <cmath>

#include <gtest/gtest.h>

#include "tests/steady_cases.hpp"

namespace strongpoint {
namespace {

constexpr const char* spectral = "fdm[order=spectral,exact=mapped]";
/// Figures of the recipes have two digits; they are met within this.
constexpr double recipe_tolerance = 0.1;

struct Figure {
  int level;
  double concentration, displacement;
};

/// sif_error and displacement_error of the plate.
void expect_plate(CaseKey key, const std::vector<Figure>& figures) {
  for (const Figure& figure : figures) {
    key.level = figure.level;
    const std::vector<double> errors = errors_of(key);
    EXPECT_NEAR(errors[0] / figure.concentration, 1, recipe_tolerance) << key.method << key.level;
    EXPECT_NEAR(errors[1] / figure.displacement, 1, recipe_tolerance) << key.method << key.level;
  }
}

TEST(PlateOnBlocks, MeetsTheRecipesOfDifferences) {
  expect_plate(steady_case("plate_hole", "fdm[order=6,exact=mapped]", "blocks[nodes=clustered]", 0),
               {{11, 1.8e-4, 8.4e-5}, {21, 4.3e-6, 4.1e-6}, {41, 7.5e-8, 7.9e-8}});
  expect_plate(steady_case("plate_hole", "fdm[order=8,exact=mapped]", "blocks[nodes=clustered]", 0),
               {{11, 8.1e-6, 6.9e-6}, {21, 8.0e-8, 8.3e-8}, {41, 4.0e-10, 4.2e-10}});
}

TEST(PlateOnBlocks, MeetsTheRecipeOfChebyshevLines) {
  expect_plate(
      steady_case("plate_hole", spectral, "blocks[nodes=chebyshev]", 0),
      {{8, 4.9e-6, 1.8e-4}, {10, 6.1e-7, 4.0e-6}, {12, 6.6e-9, 5.5e-8}, {14, 4e-11, 5e-10}});
}

}  // namespace
}  // namespace strongpoint
