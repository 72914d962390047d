#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "problems/core/cell_faces.hpp"
#include "problems/core/convex_cell.hpp"
#include "problems/core/layout.hpp"
#include "problems/core/voronoi.hpp"
#include "tests/cloud_checks.hpp"
#include "tests/face_checks.hpp"
#include "tests/sphere_wedge.hpp"

namespace strongpoint {
namespace {

template <int Dim>
void expect_cube_cells(const PointCloud<Dim>& cloud) {
  const UnitCube<Dim> cube;
  const CellFaces<Dim> faces = faces_of<Dim>(cloud, cube);
  expect_closed_cells(cloud, faces);
  EXPECT_NEAR(total_measure(cloud, faces), 1, sum_round_off);
  for (double size : side_measures<Dim>(cube, faces)) EXPECT_NEAR(size, 1, sum_round_off);
  const Eigen::VectorXd volumes =
      voronoi_volumes<Dim>(cloud, cube, *make_search<Dim>("auto", cloud.nodes));
  for (int i = 0; i < cloud.size(); ++i) {
    EXPECT_NEAR(cell_measure<Dim>(cloud.nodes.col(i), faces.of(i)), volumes[i],
                sum_round_off * volumes[i]);
  }
}

TEST(CellFaces3d, CellsShareTheLineAndTheCube) {
  for (const char* layout : {"grid", "perturbed", "random"}) {
    expect_cube_cells<1>(unit_cloud<1>(layout, 9));
    expect_cube_cells<3>(unit_cloud<3>(layout, 6));
  }
  const PointCloud<3> cloud = unit_cloud<3>("perturbed", 6);
  for (int gauss = 1; gauss <= 4; ++gauss) {
    const CellFaces<3> faces = faces_of<3>(cloud, UnitCube<3>(), gauss);
    expect_closed_cells(cloud, faces);
    EXPECT_NEAR(total_measure(cloud, faces), 1, sum_round_off);
  }
  const CellFaces<3> faces = faces_of<3>(cloud, UnitCube<3>(), 1);
  expect_shared_faces(cloud, faces);
}

TEST(CellFaces3d, RulesOnFacesHaveTheirDegree) {
  constexpr std::array<int, 5> degrees{0, 1, 2, 4, 6};
  const PointCloud<3> cloud = unit_cloud<3>("scattered", 5);
  for (int gauss = 1; gauss <= 4; ++gauss) {
    const CellFaces<3> faces = faces_of<3>(cloud, UnitCube<3>(), gauss);
    for (int a = 0; a <= degrees[gauss]; ++a) {
      const int b = degrees[gauss] - a;
      double sum = 0;
      for (const FacePoint<3>& point : faces.points) {
        if (point.side != 5) continue;
        sum += std::pow(point.x[0], a) * std::pow(point.x[1], b) * point.area[2];
      }
      EXPECT_NEAR(sum, 1.0 / ((a + 1) * (b + 1)), sum_round_off) << "gauss " << gauss;
    }
  }
}

constexpr const char* perturbed = "perturbed[amount=0.25,boundary=slide]";

/// Relative errors of the volume, and of the areas of the two curved sides, on the wedge.
std::array<double, 3> wedge_errors(const std::string& layout, int level, int gauss) {
  const SphereWedge wedge;
  const PointCloud<3> cloud = make_cloud<3>(wedge, layout, {level, 1});
  const CellFaces<3> faces = faces_of<3>(cloud, wedge, gauss);
  expect_closed_cells(cloud, faces);
  expect_shared_faces(cloud, faces);
  const std::vector<double> areas = side_measures<3>(wedge, faces);
  const double angle = SphereWedge::solid_angle();
  return {std::abs(total_measure(cloud, faces) / wedge.measure() - 1),
          std::abs(areas[0] / angle - 1), std::abs(areas[1] / (4 * angle) - 1)};
}

TEST(CellFaces3d, CellsFollowConvexAndConcaveSpheres) {
  constexpr std::array<double, 4> orders{0, 2, 4, 6};
  for (int gauss = 1; gauss <= 3; ++gauss) {
    const std::array<double, 3> coarse = wedge_errors("grid", 6, gauss);
    const std::array<double, 3> fine = wedge_errors("grid", 11, gauss);  // half the spacing
    for (std::size_t i = 0; i < coarse.size(); ++i) {
      const double slope = std::log2(coarse[i] / fine[i]);
      EXPECT_NEAR(slope, orders[gauss], 0.2) << "gauss " << gauss << " quantity " << i;
    }
  }
  EXPECT_LT(wedge_errors(perturbed, 11, 2)[0], 2e-7);
  EXPECT_LT(wedge_errors(perturbed, 11, 3)[0], 1e-9);
}

TEST(CellFaces3d, FluxesOfDivergenceFreeFieldsBalance) {
  const SphereWedge wedge;
  std::vector<double> worst;
  for (int level : {5, 9}) {
    const PointCloud<3> cloud = make_cloud<3>(wedge, perturbed, {level, 1});
    const CellFaces<3> faces = faces_of<3>(cloud, wedge, 3);
    worst.push_back(0);
    for (int i = 0; i < cloud.size(); ++i) {
      double quadratic = 0;
      for (const FacePoint<3>& point : faces.of(i)) {
        const Point<3>& x = point.x;
        quadratic += Point<3>(x[0] * x[1], -x[1] * x[1], x[1] * x[2]).dot(point.area);
      }
      const double measure = cell_measure<3>(cloud.nodes.col(i), faces.of(i));
      worst.back() = std::max(worst.back(), std::abs(quadratic) / measure);
    }
  }
  EXPECT_LT(worst[0], 2e-5);
  // Fluxes err by h^6 on patches of area h^2, compared with volumes of h^3: at least h^4 in all.
  EXPECT_LT(worst[1], worst[0] / 8);
}

TEST(CellFaces3d, SidesOfTheWedgeAreLabelled) {
  const SphereWedge wedge;
  const CellFaces<3> faces = faces_of<3>(make_cloud<3>(wedge, perturbed, {7, 2}), wedge, 3);
  const std::vector<double> areas = side_measures<3>(wedge, faces);
  // A flat side is a sector of the great circle that ends where the other two planes cut it.
  const double t = std::tan(SphereWedge::half_angle);
  const double half_sector = std::atan(t / std::sqrt(1 + t * t));
  for (int side = 2; side < 6; ++side) {
    EXPECT_NEAR(areas[side], half_sector * (4 - 1), 1e-7) << wedge.sides()[side];
  }
}

}  // namespace
}  // namespace strongpoint
