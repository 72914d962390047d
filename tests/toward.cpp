// Corners and curves of domains, and layouts that concentrate nodes at them.
#include <cmath>

#include "problems/core/domains/bored_block.hpp"
#include "problems/core/domains/quarter_annulus.hpp"
#include "problems/core/domains/quarter_plate.hpp"
#include "problems/core/domains/shell_octant.hpp"
#include "tests/domain_checks.hpp"

namespace strongpoint {
namespace {

using Point2 = Point<2>;

TEST(Features, MeasureDistancesFromPlacesByName) {
  const Polygon membrane = cook();
  EXPECT_DOUBLE_EQ(feature<2>(membrane, "corner3").distance({48, 52}), 8);
  EXPECT_DOUBLE_EQ(feature<2>(membrane, "corners").distance({48, 46}), 2);
  EXPECT_DOUBLE_EQ(feature<2>(membrane, "right").distance({40, 50}), 8);
  EXPECT_DOUBLE_EQ(feature<2>(notched(), "free").distance({0.7, 0.6}), 0.5);
  const QuarterAnnulus annulus(1, 4, Radii::geometric);
  EXPECT_DOUBLE_EQ(feature<2>(annulus, "inner").distance({0, 2.5}), 1.5);
  EXPECT_DOUBLE_EQ(feature<2>(annulus, "corners").distance({0.75, 4}), 0.75);
  const QuarterPlate plate(0.2, QuarterPlate::Map::log);
  EXPECT_DOUBLE_EQ(feature<2>(plate, "notch").distance({0.3, 0.6}), 0.5);
  EXPECT_DOUBLE_EQ(feature<2>(plate, "hole").distance({0.3, 0.4}), 0.3);
  EXPECT_DOUBLE_EQ(feature<2>(plate, "corners").distance({1, 0.7}), 0.3);
  EXPECT_DOUBLE_EQ(feature<3>(ShellOctant(1, 2), "outer").distance({0, 0, 1.5}), 0.5);
  EXPECT_DOUBLE_EQ(feature<3>(BoredBlock(), "ligament").distance({0.3, 2.2, 0.4}), 0.5);
  EXPECT_DOUBLE_EQ(feature<3>(UnitCube<3>(), "corners").distance({1, 0.75, 0}), 0.25);
  EXPECT_DOUBLE_EQ(feature<3>(UnitCube<3>(), "top").distance({1, 0.75, 0}), 0.25);
}

TEST(Features, HaveDistinctNamesAndVanishSomewhereOnTheBoundary) {
  const auto check = [&]<int Dim>(const Domain<Dim>& domain) {
    const PointCloud<Dim> cloud = make_cloud<Dim>(domain, "scattered", {9, 1});
    std::vector<std::string> names;
    for (const Feature<Dim>& feature : domain.features()) {
      EXPECT_EQ(std::count(names.begin(), names.end(), feature.name), 0) << feature.name;
      names.push_back(feature.name);
      double least = 1;
      for (int i = 0; i < cloud.size(); ++i) {
        const double distance = feature.distance(cloud.nodes.col(i));
        EXPECT_GE(distance, 0) << feature.name;
        least = std::min(least, distance);
      }
      EXPECT_LT(least, gap_tolerance) << feature.name;
    }
    for (const std::string& side : domain.sides()) {
      EXPECT_EQ(std::count(names.begin(), names.end(), side), 1) << side;
    }
  };
  check(cook());
  check(notched());
  check(QuarterAnnulus(1, 4, Radii::uniform));
  check(QuarterPlate(0.2, QuarterPlate::Map::log));
  check(ShellOctant(1, 2));
  check(BoredBlock());
  check(UnitCube<1>());
  check(UnitCube<2>());
  check(UnitCube<3>());
}

TEST(Toward, ConcentratesScatteredNodesAsTheDomainItselfWould) {
  const Points<2> own = make_cloud<2>(cook(0.1), "scattered", {13, 1}).nodes;
  const Points<2> asked =
      make_cloud<2>(cook(), "scattered[toward=corners,grade=0.1,reach=20]", {13, 1}).nodes;
  EXPECT_EQ(own, asked);
  // The default grade is 0.1, the default reach 0.4 of the length of 48.
  const Points<2> standard = make_cloud<2>(cook(), "scattered[toward=corners]", {13, 1}).nodes;
  const Points<2> spelt =
      make_cloud<2>(cook(), "scattered[toward=corners,reach=19.2,grade=0.1]", {13, 1}).nodes;
  ASSERT_EQ(standard.cols(), spelt.cols());
  EXPECT_LT((standard - spelt).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(Toward, TakesSeveralPlaces) {
  const PointCloud<2> cloud =
      make_cloud<2>(cook(), "scattered[toward=corner1+corner3,grade=0.2,reach=20]", {13, 1});
  const auto nearest_to = [&](const Point2& x) {
    std::vector<double> distances;
    for (int i = 0; i < cloud.size(); ++i) {
      const double distance = (cloud.nodes.col(i) - x).norm();
      if (distance > 0) distances.push_back(distance);
    }
    return *std::min_element(distances.begin(), distances.end());
  };
  EXPECT_LT(nearest_to({0, 0}), 1.2 * 0.2 * 4);
  EXPECT_LT(nearest_to({48, 60}), 1.2 * 0.2 * 4);
  EXPECT_GT(nearest_to({0, 44}), 0.8 * 4);
  EXPECT_GT(nearest_to({48, 44}), 0.6 * 4);  // the short side grows towards it
}

TEST(Toward, GivesRandomNodesTheSameDensity) {
  const int level = 41;
  const std::string options = "[toward=left,grade=0.2,reach=0.5]";
  const PointCloud<2> cloud = unit_cloud<2>("random" + options, level);
  expect_cube_marks(cloud);
  // Integral of 1 / (h f)^2, f = 0.2 + 1.6 x up to x = 1/2, by strips.
  const double h = 1.0 / (level - 1);
  const auto primitive = [](double x) { return -1 / (1.6 * (0.2 + 1.6 * x)); };
  const double strip = primitive(0.1) - primitive(0), all = primitive(0.5) - primitive(0) + 0.5;
  int in_strip = 0, inside = 0;
  for (int i = 0; i < cloud.size(); ++i) {
    inside += cloud.is_boundary(i) ? 0 : 1;
    in_strip += !cloud.is_boundary(i) && cloud.nodes(0, i) < 0.1 ? 1 : 0;
  }
  const double cells = all / (h * h);
  EXPECT_NEAR(cloud.size() / cells, 1, 0.06);  // boundary nodes own parts of a cell
  // Five standard deviations of a binomial.
  const double share = strip / all;
  EXPECT_NEAR(in_strip, share * inside, 5 * std::sqrt(share * (1 - share) * inside));
}

TEST(Toward, RefusesUnknownPlacesListingTheKnown) {
  std::string message;
  try {
    make_cloud<2>(cook(), "random[toward=corners+notch]", {5, 1});
  } catch (const SkipCase& skip) {
    message = skip.what();
  }
  EXPECT_EQ(message,
            "toward=notch: the domain has nothing of this name; known: bottom, right, top, "
            "clamped, corners, corner1, corner2, corner3, corner4");
  EXPECT_THROW(unit_cloud<2>("scattered[grade=0.5]", 5), UsageError);
  EXPECT_THROW(unit_cloud<2>("scattered[toward=left,grade=2]", 5), UsageError);
  EXPECT_THROW(unit_cloud<2>("scattered[toward=left,reach=0]", 5), UsageError);
}

}  // namespace
}  // namespace strongpoint
