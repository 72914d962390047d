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

/// The recipe counts a shared node once; the displacement here counts it in every block.
TEST(PlateOnBlocks, MeetsTheRecipeOfGaussLobattoRows) {
  CaseKey key = steady_case("plate_hole", spectral, "blocks[nodes=gll,split=1x2]", 0);
  key.form = "gll";
  expect_plate(
      key, {{7, 7.6e-5, 3.9e-6}, {9, 1.9e-7, 3.9e-8}, {10, 9.9e-8, 5.6e-9}, {12, 2.4e-10, 7e-11}});
}

TEST(PlateOnBlocks, IsSolvedAlikeByTheDenseSolver) {
  CaseKey key = steady_case("plate_hole", spectral, "blocks[nodes=chebyshev]", 9);
  const std::vector<double> sparse = errors_of(key);
  key.solver = "dense_lu";
  const std::vector<double> dense = errors_of(key);
  for (std::size_t q = 0; q < sparse.size(); ++q) EXPECT_NEAR(dense[q] / sparse[q], 1, 1e-6);
}

/// v_C of Cook's membrane at nu = 0.49, where displacements alone lock on other forms: 6 x 6 cells
/// graded towards the corners.
TEST(CookOnBlocks, DoesNotLock) {
  CaseKey key = steady_case("cook[nu=0.49]", spectral, "blocks[nodes=gll,split=6,ratio=0.16]", 5);
  key.form = "gll";
  EXPECT_NEAR(errors_of(key)[2] / 1.5e-3, 1, recipe_tolerance);  // 1200 unknown displacements
  key.level = 7;
  EXPECT_NEAR(errors_of(key)[2] / 3.1e-4, 1, recipe_tolerance);  // 2664
}

/// Scalar fields, faces, cross points and, in 3D, edges between eight blocks.
TEST(SplitBlocks, AreJoinedToSpectralAccuracy) {
  for (const char* form : {"collocation", "gll"}) {
    for (const char* problem : {"poisson_square", "poisson_square[bc=mixed]", "graded_material"}) {
      CaseKey key = steady_case(problem, spectral, "blocks[nodes=gll,split=3]", 9);
      key.form = form;
      EXPECT_LT(errors_of(key)[0], 1e-8) << problem << " with " << form;
    }
    for (const char* problem : {"poisson_cube[bc=mixed]", "elastic_cube[traction=three]"}) {
      CaseKey key = steady_case(problem, spectral, "blocks[nodes=gll,split=2]", 6);
      key.form = form;
      EXPECT_LT(errors_of(key)[0], 1e-5) << problem << " with " << form;
    }
  }
}

TEST(SplitBlocks, OfPatchesAreExactInTheFormGll) {
  for (const char* cloud : {"blocks[nodes=gll]", "blocks[nodes=gll,split=2]"}) {
    CaseKey key = steady_case("two_materials", spectral, cloud, 5);
    key.form = "gll";
    for (const double error : errors_of(key)) EXPECT_LT(error, 1e-11) << cloud;
  }
}

TEST(Gll, SaysWhatItCannotDo) {
  const auto refuses = [](CaseKey key) {
    key.form = "gll";
    EXPECT_THROW(run_steady_case(key, RunOptions{}), SkipCase) << key.method << key.cloud;
  };
  refuses(steady_case("plate_hole", "lsfdm", "blocks[nodes=gll]", 6));
  refuses(steady_case("plate_hole", spectral, "blocks[nodes=chebyshev]", 6));
  refuses(steady_case("plate_hole", spectral, "grid", 6));
  refuses(steady_case("plate_hole[unknowns=mixed]", spectral, "blocks[nodes=gll]", 6));
}

}  // namespace
}  // namespace strongpoint
