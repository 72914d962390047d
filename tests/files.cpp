#include <cmath>
#include <filesystem>
#include <numbers>
#include <thread>

#include <gmsh.h>

#include "tests/file_checks.hpp"

namespace strongpoint {
namespace {

/// Meshes for the tests.
class Files : public FileTest {
 protected:
  /// Meshes a .geo script and gives the path of the mesh.
  std::string mesh(const std::string& script, int dim, int order = 1) const {
    gmsh::initialize();
    gmsh::option::setNumber("General.Terminal", 0);
    gmsh::open(script);
    gmsh::model::mesh::generate(dim);
    gmsh::model::mesh::setOrder(order);
    gmsh::write(path("mesh.msh"));
    gmsh::finalize();
    return path("mesh.msh");
  }
};

/// A square with all sides named but the bottom. Gmsh overlooks a last line that does not end.
constexpr const char* open_square = R"(
Point(1) = {0, 0, 0, 0.2}; Point(2) = {1, 0, 0, 0.2}; Point(3) = {1, 1, 0, 0.2}; Point(4) = {0, 1, 0, 0.2};
Point(9) = {5, 5, 0, 0.2};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {4, 3}; Line(4) = {4, 1};
Curve Loop(1) = {1, 2, -3, 4}; Plane Surface(1) = {1};
Physical Surface("inside") = {1};
Physical Curve("right") = {2}; Physical Curve("top") = {3}; Physical Curve("left") = {4};
)";

const std::string square = std::string(open_square) + "Physical Curve(\"bottom\") = {1};\n";

constexpr const char* cube_script = R"(
Point(1) = {0, 0, 0, 0.4};
line[] = Extrude {1, 0, 0} { Point{1}; Layers{3}; };
face[] = Extrude {0, 1, 0} { Curve{line[1]}; Layers{3}; };
body[] = Extrude {0, 0, 1} { Surface{face[1]}; Layers{3}; };
Physical Volume("inside") = {body[1]};
e = 1e-3;
Physical Surface("left") = Surface In BoundingBox {-e, -e, -e, e, 1+e, 1+e};
Physical Surface("right") = Surface In BoundingBox {1-e, -e, -e, 1+e, 1+e, 1+e};
Physical Surface("bottom") = Surface In BoundingBox {-e, -e, -e, 1+e, e, 1+e};
Physical Surface("top") = Surface In BoundingBox {-e, 1-e, -e, 1+e, 1+e, 1+e};
Physical Surface("back") = Surface In BoundingBox {-e, -e, -e, 1+e, 1+e, e};
Physical Surface("front") = Surface In BoundingBox {-e, -e, 1-e, 1+e, 1+e, 1+e};
)";

/// Expects the marks of the unit cube's geometry on a cloud with nodes in general position.
template <int Dim>
void expect_cube(const PointCloud<Dim>& cloud) {
  const UnitCube<Dim> cube;
  EXPECT_NEAR(cloud.measure, 1, round_off);
  for (int i = 0; i < cloud.size(); ++i) {
    Point<Dim> x = cloud.nodes.col(i);
    for (int c = 0; c < Dim; ++c) {
      if (std::abs(x[c] - std::round(x[c])) < round_off) x[c] = std::round(x[c]);
    }
    const std::vector<int> sides = cube.sides_at(x);
    ASSERT_EQ(cloud.marks_of(i).size(), sides.size()) << format_point(x);
    for (std::size_t m = 0; m < sides.size(); ++m) {
      const BoundaryMark<Dim>& mark = cloud.marks_of(i)[m];
      EXPECT_EQ(mark.side, sides[m]) << format_point(x);
      EXPECT_LT((mark.normal - cube.normal(sides[m], x)).norm(), round_off) << format_point(x);
    }
  }
}

TEST_F(Files, ReadATriangulatedSquare) {
  const std::string script = write("square.geo", square);
  const PointCloud<2> cloud = load<2>(UnitCube<2>(), mesh(script, 2));
  EXPECT_GE(cloud.size(), 36);  // and not the loose point at (5, 5)
  expect_cube(cloud);
}

TEST_F(Files, ReadQuadrangles) {
  const std::string script =
      write("square.geo", square + "Transfinite Surface{1}; Recombine Surface{1};\n");
  expect_cube(load<2>(UnitCube<2>(), mesh(script, 2)));
}

TEST_F(Files, ReadTetrahedra) {
  const PointCloud<3> cloud = load<3>(UnitCube<3>(), mesh(write("cube.geo", cube_script), 3));
  EXPECT_GE(cloud.size(), 64);
  expect_cube(cloud);
}

TEST_F(Files, ReadHexahedraAndPrisms) {
  std::string script = cube_script;
  for (const char* recombined : {"Layers{3}; Recombine; }", "Layers{3}; }"}) {
    // The last extrusion makes prisms of triangles; with all recombined they are hexahedra.
    std::string changed = script;
    const std::string layers = "Surface{face[1]}; Layers{3}; }";
    changed.replace(changed.find(layers), layers.size(),
                    "Surface{face[1]}; Layers{3}; Recombine; }");
    const std::string curve = "Curve{line[1]}; Layers{3}; }";
    changed.replace(changed.find(curve), curve.size(),
                    std::string("Curve{line[1]}; ") + recombined);
    const PointCloud<3> cloud = load<3>(UnitCube<3>(), mesh(write("cube.geo", changed), 3));
    EXPECT_EQ(cloud.size(), 64);
    expect_cube(cloud);
  }
}

TEST_F(Files, ReadASegment) {
  const std::string script = write("line.geo", R"(
    Point(1) = {0, 0, 0, 0.1}; Point(2) = {1, 0, 0, 0.1}; Line(1) = {1, 2};
    Physical Curve("inside") = {1}; Physical Point("left") = {1}; Physical Point("right") = {2};
)");
  const PointCloud<1> cloud = load<1>(UnitCube<1>(), mesh(script, 1));
  EXPECT_EQ(cloud.size(), 11);
  expect_cube(cloud);
}

/// The sides of the plate in problems/data, with nothing else known about it.
class PlateSides final : public Domain<2> {
 public:
  const std::vector<std::string>& sides() const override {
    static const std::vector<std::string> names{"hole", "bottom", "right", "top", "left"};
    return names;
  }
  double measure() const override { return 1 - std::numbers::pi / 100; }
  double reference_length() const override { return 1; }
  Point<2> map(const Point<2>& unit) const override { return unit; }
  std::vector<int> sides_at(const Point<2>&) const override { return {}; }
  Point<2> normal(int, const Point<2>& x) const override { return x; }
  double distance(const Point<2>& x) const override { return 0.2 - x.norm(); }
  std::vector<BoundaryPiece<2>> pieces() const override { return {}; }
};

TEST_F(Files, ReadThePlateWithAHole) {
  const std::string script = std::string(STRONGPOINT_SOURCE_DIR) + "/problems/data/plate_hole.geo";
  ASSERT_TRUE(std::filesystem::exists(script)) << script;
  const PlateSides plate;
  const PointCloud<2> cloud = load<2>(plate, mesh(script, 2));
  // Chords cut segments off the hole: 20 of h^3 / (12 r) with h = r (pi/2) / 20.
  EXPECT_NEAR(cloud.measure, plate.measure(), 1e-4);
  EXPECT_GT(cloud.measure, plate.measure() - 1e-3);
  int on_hole = 0;
  for (int i = 0; i < cloud.size(); ++i) {
    const auto marks = cloud.marks_of(i);
    if (marks.empty() || marks[0].side != 0) continue;
    ++on_hole;
    const Point<2> inwards = -cloud.nodes.col(i).normalized();
    // At a corner one chord alone gives the normal: half a step of 4.5 degrees off.
    const double tolerance = marks.size() == 1 ? 1e-6 : 0.04;
    EXPECT_LT((marks[0].normal - inwards).norm(), tolerance) << format_point(cloud.nodes.col(i));
  }
  EXPECT_EQ(on_hole, 21);
}

TEST_F(Files, RefuseAMeshWithASideMissing) {
  const std::string message = refusal<2>(mesh(write("square.geo", open_square), 2));
  STRONGPOINT_EXPECT_IN("has no side", message);
  STRONGPOINT_EXPECT_IN("left, right, bottom, top", message);
  STRONGPOINT_EXPECT_IN("groups in the file: right, top, left", message);
}

TEST_F(Files, RefuseAMeshWithAnUnknownSide) {
  const std::string script =
      write("square.geo", std::string(open_square) + "Physical Curve(\"floor\") = {1};\n");
  const std::string message = refusal<2>(mesh(script, 2));
  STRONGPOINT_EXPECT_IN("physical group 'floor' is not a side", message);
  STRONGPOINT_EXPECT_IN("known sides: left, right, bottom, top", message);
}

TEST_F(Files, RefuseElementsOfSecondOrder) {
  const std::string script = write("square.geo", square);
  STRONGPOINT_EXPECT_IN("first-order", refusal<2>(mesh(script, 2, 2)));
}

TEST_F(Files, RefuseAMeshOfTheWrongDimension) {
  const std::string script = write("square.geo", square);
  STRONGPOINT_EXPECT_IN("no elements of dimension 3", refusal<3>(mesh(script, 2)));
}

TEST_F(Files, RefuseAPlaneMeshOffThePlane) {
  std::string text = square + "Translate {0, 0, 0.5} { Surface{1}; }\n";
  STRONGPOINT_EXPECT_IN("has z = 0.5", refusal<2>(mesh(write("square.geo", text), 2)));
}

TEST_F(Files, RefuseWhatIsNoMesh) {
  STRONGPOINT_EXPECT_IN("cannot be opened", refusal<2>(path("nowhere.msh")));
  STRONGPOINT_EXPECT_IN("not a Gmsh mesh", refusal<2>(write("a.msh", "Point(1) = {0, 0, 0};")));
  const std::string cut =
      write("b.msh", "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 4 1 4\n2 ");
  const std::string message = refusal<2>(cut);
  EXPECT_NE(message, "nothing was thrown");
  STRONGPOINT_EXPECT_IN("extension '.vtk' is not known", refusal<2>(write("a.vtk", "x")));
  STRONGPOINT_EXPECT_IN("cannot be opened", refusal<2>(path("nowhere.csv")));
  EXPECT_THROW(make_cloud<2>(UnitCube<2>(), "file", {5, 1}), SkipCase);
}

TEST_F(Files, CanBeReadByManyThreads) {
  const std::string script = write("square.geo", square);
  const std::string file = mesh(script, 2);
  const Points<2> expected = load<2>(UnitCube<2>(), file).nodes;
  std::vector<int> equal(4, 0);
  std::vector<std::thread> threads;
  threads.reserve(equal.size());
  for (int t = 0; t < 4; ++t) {
    threads.emplace_back(
        [&, t] { equal[t] = load<2>(UnitCube<2>(), file).nodes == expected ? 1 : 0; });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(equal, std::vector<int>(4, 1));
}

}  // namespace
}  // namespace strongpoint
