// Domains made from meshes: distance, normals, pieces, and the clouds that come of them.
#include "problems/core/domains/mesh_domain.hpp"

#include <cmath>
#include <numbers>

#include <gmsh.h>

#include "problems/core/mesh_file.hpp"
#include "problems/core/random.hpp"
#include "tests/file_checks.hpp"

namespace strongpoint {
namespace {

class MeshDomains : public FileTest {
 protected:
  /// Meshes a .geo script with elements of a relative size and gives the path of the mesh.
  std::string mesh(const std::string& script, int dim, double size = 1) const {
    gmsh::initialize();
    gmsh::option::setNumber("General.Terminal", 0);
    gmsh::option::setNumber("Mesh.MeshSizeFactor", size);
    gmsh::open(write("script.geo", script));
    gmsh::model::mesh::generate(dim);
    gmsh::write(path("mesh.msh"));
    gmsh::finalize();
    return path("mesh.msh");
  }
  template <int Dim>
  std::unique_ptr<MeshDomain<Dim>> domain(const std::string& script, double size = 1) const {
    const std::string file = mesh(script, Dim, size);
    return std::make_unique<MeshDomain<Dim>>(load_mesh(file), file);
  }
};

/// The message of the CaseError that making a domain throws.
template <class Action>
std::string message_of(Action action) {
  try {
    action();
  } catch (const CaseError& error) {
    return error.what();
  }
  return "nothing was thrown";
}

/// A plate of 2 x 1 with a round hole and a square one.
const std::string plate = R"(
SetFactory("OpenCASCADE");
Rectangle(1) = {0, 0, 0, 2, 1};
Disk(2) = {1.4, 0.5, 0, 0.2, 0.2};
Rectangle(3) = {0.3, 0.3, 0, 0.3, 0.3};
BooleanDifference(4) = { Surface{1}; Delete; }{ Surface{2, 3}; Delete; };
MeshSize{ PointsOf{ Surface{4}; } } = 0.1;
e = 1e-3;
hole[] = Curve In BoundingBox {1.2-e, 0.3-e, -e, 1.6+e, 0.7+e, e};
slot[] = Curve In BoundingBox {0.3-e, 0.3-e, -e, 0.6+e, 0.6+e, e};
left[] = Curve In BoundingBox {-e, -e, -e, e, 1+e, e};
rest[] = Boundary{ Surface{4}; };
rest[] -= hole[]; rest[] -= slot[]; rest[] -= left[];
Physical Curve("hole") = {hole[]}; Physical Curve("slot") = {slot[]};
Physical Curve("left") = {left[]}; Physical Curve("rest") = {rest[]};
Physical Surface("plate") = {4};
)";

const std::string cube = R"(
SetFactory("OpenCASCADE");
Box(1) = {0, 0, 0, 1, 1, 1};
MeshSize{ PointsOf{ Volume{1}; } } = 0.3;
e = 1e-3;
left[] = Surface In BoundingBox {-e, -e, -e, e, 1+e, 1+e};
rest[] = Boundary{ Volume{1}; };
rest[] -= left[];
Physical Surface("left") = {left[]}; Physical Surface("rest") = {rest[]};
Physical Volume("inside") = {1};
)";

/// Distance to the polyline by trying all its segments, the sign by counting crossings of a ray.
double distance_by_trying(const BoundaryMesh<2>& mesh, const Point<2>& x) {
  double least = 1e300;
  int crossings = 0;
  for (const BoundaryFacet<2>& facet : mesh.facets) {
    const Point<2> a = mesh.vertices.col(facet.corners[0]);
    const Point<2> b = mesh.vertices.col(facet.corners[1]);
    const double t = std::clamp((x - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
    least = std::min(least, (a + t * (b - a) - x).norm());
    if ((a[1] > x[1]) == (b[1] > x[1])) continue;
    crossings += a[0] + (x[1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0]) > x[0] ? 1 : 0;
  }
  return crossings % 2 == 1 ? -least : least;
}

TEST_F(MeshDomains, MeasureSignedDistanceExactlyInThePlane) {
  const auto made = domain<2>(plate);
  EXPECT_EQ(made->sides(), (std::vector<std::string>{"hole", "slot", "left", "rest"}));
  EXPECT_EQ(made->reference_length(), 2);
  // The hole is a polygon of some 13 corners.
  EXPECT_NEAR(made->measure(), 2 - 0.09 - std::numbers::pi * 0.04, 5e-3);
  std::mt19937_64 generator(3);
  for (int i = 0; i < 20000; ++i) {
    const double x = -0.5 + 3 * uniform01(generator);
    const Point<2> place(x, -0.5 + 2 * uniform01(generator));
    const double expected = distance_by_trying(made->boundary(), place);
    ASSERT_NEAR(made->distance(place), expected, round_off) << format_point(place);
  }
  for (int v = 0; v < made->boundary().vertices.cols(); ++v) {
    const Point<2> vertex = made->boundary().vertices.col(v);
    EXPECT_EQ(made->distance(vertex), 0);
    for (int k = 0; k < 16; ++k) {  // around each vertex, where the sign is hardest
      const Point<2> place =
          vertex + 1e-4 * Point<2>(std::cos(k * 0.39 + 0.01), std::sin(k * 0.39 + 0.01));
      const double expected = distance_by_trying(made->boundary(), place);
      EXPECT_NEAR(made->distance(place), expected, round_off) << format_point(place);
    }
  }
}

TEST_F(MeshDomains, MeasureSignedDistanceExactlyInSpace) {
  const auto made = domain<3>(cube);
  const UnitCube<3> exact;
  EXPECT_NEAR(made->measure(), 1, round_off);
  std::mt19937_64 generator(4);
  for (int i = 0; i < 20000; ++i) {
    Point<3> x;
    for (int c = 0; c < 3; ++c) x[c] = -0.5 + 2 * uniform01(generator);
    if (i % 3 == 0) x[i % 9 / 3] = (i / 9) % 2;  // in the plane of a face
    ASSERT_NEAR(made->distance(x), exact.distance(x), round_off) << format_point(x);
  }
  EXPECT_LT((made->normal(0, {0, 0.3, 0.4}) - Point<3>(-1, 0, 0)).norm(), round_off);
  EXPECT_LT((made->normal(1, {0.2, 1, 0.4}) - Point<3>(0, 1, 0)).norm(), round_off);
  EXPECT_TRUE(made->pieces().empty());
  EXPECT_THROW(make_cloud<3>(*made, "scattered", {5, 1}), SkipCase);
}

TEST_F(MeshDomains, HaveOnePieceASmoothRunOfASide) {
  const auto made = domain<2>(plate);
  std::vector<int> pieces_of(4, 0);
  const Eigen::Matrix<double, 1, 1> begin(0.0);
  const Eigen::Matrix<double, 1, 1> end(1.0);
  for (const BoundaryPiece<2>& piece : made->pieces()) {
    ++pieces_of[piece.side];
    if (piece.side == 0) {
      EXPECT_EQ(piece.map(begin), piece.map(end)) << "the circle is closed";
    }
    for (int i = 0; i <= 100; ++i) {
      const Eigen::Matrix<double, 1, 1> t(i / 100.0);
      EXPECT_NEAR(made->distance(piece.map(t)), 0, round_off);
    }
  }
  EXPECT_EQ(pieces_of, (std::vector<int>{1, 4, 1, 3}));
}

TEST_F(MeshDomains, AreFilledWithScatteredNodesOfAnyLevel) {
  const auto made = domain<2>(plate, 0.2);
  for (const int level : {15, 60}) {
    const PointCloud<2> cloud = make_cloud<2>(*made, "scattered", {level, 1});
    const double h = 2.0 / (level - 1);
    EXPECT_NEAR(cloud.size() * h * h / made->measure(), 1, 0.35) << "as dense as a grid";
    int on_hole = 0;
    for (int i = 0; i < cloud.size(); ++i) {
      EXPECT_LT(made->distance(cloud.nodes.col(i)), round_off);
      for (const BoundaryMark<2>& mark : cloud.marks_of(i)) {
        if (mark.side != 0) continue;
        ++on_hole;
        const Point<2> radius = Point<2>(1.4, 0.5) - cloud.nodes.col(i);
        // Between mean normals of edges of 0.02: off by less than (0.02 / 0.2)^2 / 4.
        EXPECT_LT((mark.normal - radius.normalized()).norm(), 2.5e-3);
      }
    }
    EXPECT_NEAR(on_hole * h / (0.4 * std::numbers::pi), 1, 0.15);
  }
}

TEST_F(MeshDomains, OfferTheirOwnNodesAsACloud) {
  const auto made = domain<2>(plate);
  const PointCloud<2> own = make_cloud<2>(*made, "file", {0, 1});
  const PointCloud<2> read = read_mesh<2>(*made, path("mesh.msh"));
  ASSERT_EQ(own.size(), read.size());
  for (int i = 0; i < own.size(); ++i) {  // in an order of its own
    EXPECT_EQ(own.nodes.col(i), read.nodes.col(own.number_of(i))) << i;
    for (const BoundaryMark<2>& mark : own.marks_of(i)) {
      const Point<2> normal = made->normal(mark.side, own.nodes.col(i));
      EXPECT_LT((mark.normal - normal).norm(), round_off) << format_point(own.nodes.col(i));
    }
  }
  EXPECT_THROW(make_cloud<2>(UnitCube<2>(), "file", {0, 1}), SkipCase);
}

TEST_F(MeshDomains, RefuseGridsWithARemedy) {
  const auto made = domain<2>(plate);
  try {
    make_cloud<2>(*made, "grid", {5, 1});
    FAIL() << "a grid was made";
  } catch (const SkipCase& error) {
    EXPECT_NE(std::string(error.what()).find("--cloud file"), std::string::npos);
  }
}

TEST_F(MeshDomains, NameWhatIsWrongWithTheGroups) {
  const std::string unassigned =
      message_of([&] { domain<2>(plate + "Physical Curve(\"left\") -= {left[]};\n"); });
  EXPECT_NE(unassigned.find("has no side"), std::string::npos) << unassigned;
  EXPECT_NE(unassigned.find("hole, slot, rest"), std::string::npos) << unassigned;
  const std::string twice =
      message_of([&] { domain<2>(plate + "Physical Curve(\"round\") = {hole[]};\n"); });
  EXPECT_NE(twice.find("'hole' and 'round'"), std::string::npos) << twice;
  EXPECT_TRUE(twice.starts_with(path("mesh.msh"))) << twice;
}

TEST_F(MeshDomains, RefuseBoundaryThatTouchesItself) {
  const std::string touching = R"(
Point(1) = {0, 0, 0, 0.5}; Point(2) = {1, 0, 0, 0.5}; Point(3) = {1, 1, 0, 0.5};
Point(4) = {2, 1, 0, 0.5}; Point(5) = {2, 2, 0, 0.5}; Point(6) = {1, 2, 0, 0.5};
Point(7) = {0, 1, 0, 0.5};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 7}; Line(4) = {7, 1};
Line(5) = {3, 4}; Line(6) = {4, 5}; Line(7) = {5, 6}; Line(8) = {6, 3};
Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};
Curve Loop(2) = {5, 6, 7, 8}; Plane Surface(2) = {2};
Physical Curve("all") = {1:8}; Physical Surface("both") = {1, 2};
)";
  const std::string message = message_of([&] { domain<2>(touching); });
  EXPECT_NE(message.find("touches itself at (1, 1)"), std::string::npos) << message;
}

}  // namespace
}  // namespace strongpoint
