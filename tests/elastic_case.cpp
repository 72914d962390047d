// Case files of elasticity: what they say, what is refused and how, and what becomes of them on a
// mesh.
#include "problems/core/elastic_case.hpp"

#include <map>

#include <gmsh.h>

#include "problems/core/elastic_conditions.hpp"
#include "problems/core/mesh_file.hpp"
#include "problems/core/problem.hpp"
#include "studies/support/run_case.hpp"
#include "tests/file_checks.hpp"

namespace strongpoint {
namespace {

const std::string material = "mesh = \"plate.msh\"\n[material]\nyoung = 200\npoisson = 0.25\n";

/// A square of side 2 with its lower left corner at (1, 1).
constexpr const char* square = R"(
SetFactory("OpenCASCADE");
Rectangle(1) = {1, 1, 0, 2, 2};
MeshSize{ PointsOf{ Surface{1}; } } = 0.25;
Physical Curve("bottom") = {1}; Physical Curve("right") = {2};
Physical Curve("top") = {3}; Physical Curve("left") = {4};
Physical Surface("plate") = {1};
)";

/// The same as a cube.
constexpr const char* cube = R"(
SetFactory("OpenCASCADE");
Box(1) = {1, 1, 1, 2, 2, 2};
MeshSize{ PointsOf{ Volume{1}; } } = 0.5;
Physical Surface("left") = {1}; Physical Surface("right") = {2}; Physical Surface("bottom") = {3};
Physical Surface("top") = {4}; Physical Surface("back") = {5}; Physical Surface("front") = {6};
Physical Volume("block") = {1};
)";

class ElasticCases : public FileTest {
 protected:
  ElasticCase read(const std::string& text) const {
    return read_elastic_case(write("case.toml", text));
  }
  /// The message of the error that an action throws, after the path that it must begin with.
  template <class Action>
  std::string message_of(Action action) const {
    try {
      action();
    } catch (const CaseError& error) {
      const std::string message = error.what();
      EXPECT_TRUE(message.starts_with(path("case.toml"))) << message;
      return message.substr(path("case.toml").size());
    }
    return "nothing was thrown";
  }
  std::string refusal(const std::string& text) const {
    return message_of([&] { read(text); });
  }
  Mesh mesh(const char* script, int dim) const {
    gmsh::initialize();
    gmsh::option::setNumber("General.Terminal", 0);
    gmsh::open(write("plate.geo", script));
    gmsh::model::mesh::generate(dim);
    gmsh::write(path("plate.msh"));
    gmsh::finalize();
    return load_mesh(path("plate.msh"));
  }
  template <int Dim>
  ElasticConditions<Dim> conditions(const std::string& text) const {
    const ElasticCase elastic = read(material + text);
    return conditions_of(elastic,
                         MeshDomain<Dim>(mesh(Dim == 2 ? square : cube, Dim), "plate.msh"));
  }
  std::string mismatch(const std::string& text) const {
    return message_of([&] { conditions<2>(text); });
  }
};

TEST_F(ElasticCases, SayWhatTheirFileSays) {
  const ElasticCase elastic = read(
      "mesh = \"part/bracket.msh\"\n[material]\nyoung = 210e9\npoisson = 0.3\n"
      "state = \"plane_stress\"\n[support.wall]\nux = 0\nuy = -0.5\n[support.slide]\n"
      "symmetry = true\n[load.hook]\ntraction = [0, -1e6]\n[load.hole]\npressure = 3\n"
      "[body]\nforce = [0.0, -7.7e4]\n[probe]\ntip = [0.4, 0.1]\nend = [0.5, 0.1]\n");
  EXPECT_EQ(elastic.mesh, path("part/bracket.msh")) << "found from where the case is";
  EXPECT_EQ(elastic.young, 210e9);
  EXPECT_EQ(elastic.poisson, 0.3);
  EXPECT_EQ(elastic.state, PlaneState::stress);
  ASSERT_EQ(elastic.supports.size(), 2U);
  EXPECT_EQ(elastic.supports[0].group, "wall");
  EXPECT_EQ(elastic.supports[0].displacement[0], 0.0);
  EXPECT_EQ(elastic.supports[0].displacement[1], -0.5);
  EXPECT_FALSE(elastic.supports[0].displacement[2].has_value());
  EXPECT_TRUE(elastic.supports[1].is_symmetry);
  ASSERT_EQ(elastic.loads.size(), 2U);
  EXPECT_EQ(elastic.loads[0].traction, (std::vector<double>{0, -1e6}));
  EXPECT_EQ(elastic.loads[1].pressure, 3);
  EXPECT_EQ(elastic.force, (std::vector<double>{0, -7.7e4}));
  ASSERT_EQ(elastic.probes.size(), 2U);
  EXPECT_EQ(elastic.probes[0].name, "tip") << "in the order of the file";
}

TEST_F(ElasticCases, MovePlaneStressByAnEffectiveLame) {
  const ElasticCase strain = read(material);
  const ElasticCase stress = read(material + "state = \"plane_stress\"\n");
  const Lame lame = material_of(strain);
  EXPECT_NEAR(lame.lambda, 80, 1e-12);
  EXPECT_NEAR(lame.mu, 80, 1e-12);
  // Under uniaxial stress: eps_xx = sigma / E and eps_yy = -nu sigma / E.
  const Eigen::Matrix2d sigma =
      strongpoint::stress<2>(material_of(stress), Eigen::Vector2d(1, -0.25).asDiagonal());
  EXPECT_NEAR(sigma(0, 0), 200, 1e-12);
  EXPECT_NEAR(sigma(1, 1), 0, 1e-12);
}

TEST_F(ElasticCases, AreRefusedWithTheLineAndARemedy) {
  STRONGPOINT_EXPECT_IN("check the path", refusal(""));
  STRONGPOINT_EXPECT_IN("line 2: is no TOML", refusal("mesh = \"a.msh\"\nyoung 3\n"));
  STRONGPOINT_EXPECT_IN("mesh is missing", refusal("[material]\nyoung = 1\npoisson = 0\n"));
  STRONGPOINT_EXPECT_IN("[material] is missing", refusal("mesh = \"a.msh\"\n"));
  STRONGPOINT_EXPECT_IN("line 1: mesh must be a text", refusal("mesh = 3\n"));
  STRONGPOINT_EXPECT_IN("line 5: unknown key densty in [material]; known: young, poisson, state",
                        refusal(material + "densty = 3\n"));
  STRONGPOINT_EXPECT_IN("line 5: unknown key supports; known: mesh, material, support",
                        refusal(material + "[supports.wall]\nux = 0\n"));
  STRONGPOINT_EXPECT_IN("young in [material] is missing",
                        refusal("mesh = \"a.msh\"\n[material]\npoisson = 0.3\n"));
  STRONGPOINT_EXPECT_IN("line 4: poisson = 0.5 must be",
                        refusal("mesh = \"a.msh\"\n[material]\nyoung = 1\npoisson = 0.5\n"));
  STRONGPOINT_EXPECT_IN("young = -1 must be positive",
                        refusal("mesh = \"a.msh\"\n[material]\nyoung = -1\npoisson = 0.3\n"));
  STRONGPOINT_EXPECT_IN("young in [material] is not a number",
                        refusal("mesh = \"a.msh\"\n[material]\nyoung = \"steel\"\npoisson = 0\n"));
  STRONGPOINT_EXPECT_IN("= inf is not finite",
                        refusal("mesh = \"a.msh\"\n[material]\nyoung = inf\npoisson = 0\n"));
  STRONGPOINT_EXPECT_IN("allowed: plane_strain, plane_stress",
                        refusal(material + "state = \"flat\"\n"));
}

TEST_F(ElasticCases, AreRefusedForConditionsThatSayTooLittleOrTooMuch) {
  STRONGPOINT_EXPECT_IN("line 5: [support.wall] gives nothing",
                        refusal(material + "[support.wall]\n"));
  STRONGPOINT_EXPECT_IN("line 6: [support] ux is no group",
                        refusal(material + "[support]\nux = 0\n"));
  STRONGPOINT_EXPECT_IN("alone", refusal(material + "[support.wall]\nsymmetry = true\nux = 0\n"));
  STRONGPOINT_EXPECT_IN("unknown key x in [support.wall]; known: ux, uy, uz, symmetry",
                        refusal(material + "[support.wall]\nx = 0\n"));
  STRONGPOINT_EXPECT_IN("either traction or pressure",
                        refusal(material + "[load.top]\npressure = 1\ntraction = [0, 1]\n"));
  STRONGPOINT_EXPECT_IN("line 6: traction in [load.top] is not a list",
                        refusal(material + "[load.top]\ntraction = 1\n"));
  STRONGPOINT_EXPECT_IN("line 7: group 'top' has a support (line 5) and a load (line 7)",
                        refusal(material + "[support.top]\nux = 0\n[load.top]\npressure = 1\n"));
  STRONGPOINT_EXPECT_IN("line 7: is no TOML",
                        refusal(material + "[support.top]\nux = 0\n[support.top]\nuy = 0\n"));
  STRONGPOINT_EXPECT_IN("force in [body] is missing", refusal(material + "[body]\n"));
  STRONGPOINT_EXPECT_IN("a name of letters", refusal(material + "[probe]\n\"a b\" = [0, 0]\n"));
}

TEST_F(ElasticCases, AreMatchedWithTheSidesOfTheirMesh) {
  const ElasticConditions<2> made = conditions<2>(
      "[support.left]\nsymmetry = true\n[support.bottom]\nux = 0.5\nuy = 1\n"
      "[load.top]\ntraction = [3, 4]\n[load.right]\npressure = 2\n[body]\nforce = [5, 6]\n"
      "[probe]\na = [3, 3]\n");
  ASSERT_EQ(made.sides.size(), 4U);  // bottom, right, top, left
  EXPECT_EQ(made.sides[0].displacement[0], 0.5);
  EXPECT_EQ(made.sides[0].displacement[1], 1.0);
  EXPECT_EQ(made.sides[1].pressure, 2);
  EXPECT_EQ(made.sides[2].traction, Point<2>(3, 4));
  EXPECT_EQ(made.sides[3].displacement[0], 0.0);
  EXPECT_FALSE(made.sides[3].displacement[1].has_value());
  ASSERT_EQ(made.symmetry_planes.size(), 1U);
  EXPECT_EQ(made.symmetry_planes[0].axis, 0);
  EXPECT_NEAR(made.symmetry_planes[0].offset, 1, round_off);
  EXPECT_EQ(made.force, Point<2>(5, 6));
}

TEST_F(ElasticCases, AreRefusedWhenTheirMeshDoesNotFit) {
  const std::string held = "[support.left]\nux = 0\nuy = 0\n";
  STRONGPOINT_EXPECT_IN(
      "line 8: [load.upper]: the mesh has no physical group 'upper' of dimension 1; known: bottom, "
      "right, top, left",
      mismatch(held + "[load.upper]\npressure = 1\n"));
  STRONGPOINT_EXPECT_IN("line 5: [support.lft]", mismatch("[support.lft]\nux = 0\n"));
  STRONGPOINT_EXPECT_IN("has 3 numbers, but the mesh 2 dimensions",
                        mismatch(held + "[body]\nforce = [0, 0, 1]\n"));
  STRONGPOINT_EXPECT_IN("uz is given", mismatch("[support.left]\nuz = 0\n"));
  STRONGPOINT_EXPECT_IN("the probe far at (5, 2) is 2 outside",
                        mismatch(held + "[probe]\nfar = [5, 2]\n"));
  STRONGPOINT_EXPECT_IN("state is for meshes in the plane", message_of([&] {
                          conditions<3>("state = \"plane_strain\"\n" + held + "uz = 0\n");
                        }));
}

TEST_F(ElasticCases, AreRefusedWhenTheBodyIsFreeToMove) {
  STRONGPOINT_EXPECT_IN("free to move along x and along y; add [support.GROUP] for one of: bottom",
                        mismatch(""));
  STRONGPOINT_EXPECT_IN("free to move along y", mismatch("[support.left]\nux = 0\n"));
  STRONGPOINT_EXPECT_IN("free to move along x",
                        mismatch("[support.top]\nuy = 0\n[support.bottom]\nuy = 0\n"));
  // Both normals pass through one point only for one side of each: these two hold the body.
  EXPECT_NO_THROW(conditions<2>("[support.left]\nsymmetry = true\n[support.bottom]\nuy = 0\n"));
  STRONGPOINT_EXPECT_IN("free to move along z", message_of([&] {
                          conditions<3>("[support.left]\nux = 0\n[support.bottom]\nuy = 0\n");
                        }));
  EXPECT_NO_THROW(conditions<3>(
      "[support.left]\nux = 0\n[support.bottom]\nuy = 0\n[support.back]\nsymmetry = true\n"));
}

/// Under uniform tension p along x, held by symmetry on three faces, the body strains by p / E
/// along x and -nu p / E across; its corner moves from (3, 3, 3) accordingly. Linear displacements
/// are exact in every method of second order.
template <int Dim>
void expect_uniform_tension(const std::string& spec, double p, double young, double nu) {
  const CaseKey key{spec, "lsfdm", "nearest", "file", "collocation", "umfpack", 0};
  const CaseResult result = run_steady_case(key, RunOptions{});
  std::map<std::string, double> values;
  for (const Quantity& quantity : result.quantities) values[quantity.name] = quantity.value.value();
  constexpr double solved = 1e-9;  // round-off times the condition of the linear system
  EXPECT_NEAR(values.at("ux_corner"), 2 * p / young, solved);
  EXPECT_NEAR(values.at("uy_corner"), -2 * nu * p / young, solved);
  if (Dim == 3) {
    EXPECT_NEAR(values.at("uz_corner"), -2 * nu * p / young, solved);
  }
  EXPECT_NEAR(values.at("von_mises_corner"), p, 1e3 * solved);
  EXPECT_NEAR(values.at("max_von_mises"), p, 1e3 * solved);
}

TEST_F(ElasticCases, GiveUniformTensionExactlyInPlaneStress) {
  mesh(square, 2);
  const std::string file =
      write("case.toml", material +
                             "state = \"plane_stress\"\n[support.left]\nsymmetry = true\n"
                             "[support.bottom]\nsymmetry = true\n[load.right]\npressure = -4\n"
                             "[probe]\ncorner = [3, 3]\n");
  expect_uniform_tension<2>("elastic[case=" + file + "]", 4, 200, 0.25);
}

TEST_F(ElasticCases, GiveUniformTensionExactlyInSpace) {
  mesh(cube, 3);
  const std::string file =
      write("case.toml", material +
                             "[support.left]\nsymmetry = true\n[support.bottom]\nsymmetry = true\n"
                             "[support.back]\nuz = 0\n[load.right]\ntraction = [4, 0, 0]\n"
                             "[probe]\ncorner = [3, 3, 3]\n");
  expect_uniform_tension<3>("elastic[case=" + file + "]", 4, 200, 0.25);
}

}  // namespace
}  // namespace strongpoint
