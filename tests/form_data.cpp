// What forms ask of clouds, problems and methods, and that what they write holds of exact
// solutions.
#include <Eigen/QR>
#include <gtest/gtest.h>

#include "problems/core/assembly.hpp"
#include "problems/core/jet.hpp"
#include "studies/support/run_case.hpp"
#include "tests/cloud_checks.hpp"
#include "tests/face_domains.hpp"
#include "tests/strain_problem.hpp"

namespace strongpoint {
namespace {

template <class Error, class Action>
std::string message_of(Action action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return "nothing was thrown";
}

void expect_part(const std::string& message, const std::string& part) {
  EXPECT_NE(message.find(part), std::string::npos) << "'" << message << "' lacks '" << part << "'";
}

double quantity(const CaseKey& key, const std::string& name) {
  for (const auto& found : run_steady_case(key, RunOptions{}).quantities) {
    if (found.name == name) return found.value.value();
  }
  throw std::invalid_argument(name);
}

/// The unit square without nodes on some of its sides.
PointCloud<2> cloud_without(const std::vector<int>& sides) {
  const UnitCube<2> square;
  const PointCloud<2> whole = make_cloud<2>(square, "grid", {9, 1});
  CloudBuilder<2> builder;
  for (int i = 0; i < whole.size(); ++i) {
    const Node<2> node = node_of(whole, i);
    const bool is_left_out =
        std::any_of(sides.begin(), sides.end(), [&](int side) { return node.on(side); });
    const std::span<const BoundaryMark<2>> marks = node.marks;
    if (!is_left_out) builder.add(node.x, {marks.begin(), marks.end()});
  }
  return builder.finish(1);
}

std::string refusal(const std::string& form, const std::vector<int>& sides_without_nodes) {
  const UnitCube<2> square;
  const HomogeneousStrain<2> problem(square, {"left"});
  const PointCloud<2> cloud = cloud_without(sides_without_nodes);
  const auto method = make_method<2>(form == "mlpg" ? "mls" : "lsfdm").made;
  return message_of<CaseError>([&] { make_form<2>(form)->plan(problem, cloud, *method); });
}

TEST(Forms, WantNodesOnTheSidesWhoseConditionsTheyWriteAtNodes) {
  enum { left, right };
  for (const char* form :
       {"collocation", "collocation[boundary=ghost]", "least_squares", "flux", "mlpg"}) {
    EXPECT_EQ(refusal(form, {}), "nothing was thrown") << form;
    expect_part(refusal(form, {left}), "no node lies on the side 'left'");
  }
  for (const char* form : {"collocation", "collocation[boundary=combined]", "least_squares"}) {
    expect_part(refusal(form, {right}), "no node lies on the side 'right'");
  }
  for (const char* form : {"flux", "mlpg"}) {  // given fluxes are integrated
    EXPECT_EQ(refusal(form, {right}), "nothing was thrown") << form;
  }
}

TEST(Forms, WantNoNodesOnMirroredPlanes) {
  const UnitCube<2> square;
  const HomogeneousStrain<2> problem(square, {}, {{0, 0, 0}, {2, 1, 0}});
  const PointCloud<2> cloud = cloud_without({0, 2});
  const auto method = make_method<2>("lsfdm").made;
  for (const char* form : {"collocation[symmetry=images]", "flux[symmetry=images]"}) {
    EXPECT_NO_THROW(make_form<2>(form)->plan(problem, cloud, *method)) << form;
  }
  EXPECT_THROW(make_form<2>("flux")->plan(problem, cloud, *method), CaseError);
}

/// Gradients of coefficients that are differences need a step between the nodes too. How wrong the
/// solution is at the jump is another matter.
TEST(Forms, LeastSquaresTakesCoefficientsThatAreDifferences) {
  const CaseKey key{
      "two_materials[strategy=variable]", "lsfdm", "nearest", "grid", "least_squares", "spqr", 11};
  EXPECT_LT(quantity(key, "displacement_error"), 1);
}

TEST(Forms, OfDiscsDeclineFieldsWithoutAFlux) {
  const CaseKey key{
      "cook[unknowns=mixed]", "mls", "radius[factor=3.2]", "scattered", "mlpg", "umfpack", 9};
  expect_part(message_of<SkipCase>([&] { run_steady_case(key, RunOptions{}); }),
              "the field p has none");
}

TEST(Forms, ThatAddNodesSaySoToMethodsThatNeedStructure) {
  const CaseKey key{"plate_hole", "fdm", "block", "grid", "collocation[boundary=ghost]",
                    "umfpack",    9};
  expect_part(message_of<SkipCase>([&] { run_steady_case(key, RunOptions{}); }), "ghost");
  const CaseKey rule{"plate_hole", "lsfdm", "block", "grid", "collocation[boundary=ghost]",
                     "umfpack",    9};
  expect_part(message_of<SkipCase>([&] { run_steady_case(rule, RunOptions{}); }), "ghost");
}

TEST(Problems, RefuseAPressureWhereThereIsNone) {
  for (const char* problem : {"cook", "plate_hole", "thick_cylinder", "thick_sphere"}) {
    const std::string spec = std::string(problem) + "[nu=0,unknowns=mixed]";
    const std::string message = message_of<UsageError>([&] { make_problem(spec); });
    expect_part(message, problem);
    expect_part(message, "unknowns=mixed");
    EXPECT_NO_THROW(make_problem(std::string(problem) + "[nu=0]"));
    EXPECT_NO_THROW(make_problem(std::string(problem) + "[nu=0.3,unknowns=mixed]"));
  }
}

/// A slanted side that meets a symmetry plane: its ghost belongs into the plane, where the
/// displacement across is zero.
TEST(Ghosts, OfNodesOnMirroredPlanesLieInThem) {
  const PolygonDomain wedge({{0, 0}, {1, 0}, {1, 1.5}, {0, 1}});
  constexpr int left = 3;
  const HomogeneousStrain<2> problem(wedge, {}, {{left, 0, 0}, {0, 1, 0}});
  const CaseKey key{
      "",        "lsfdm", "nearest", "scattered", "collocation[boundary=ghost,symmetry=images]",
      "umfpack", 12};
  EXPECT_LT(solve_steady<2>(problem, key, RunOptions{}).quantities[0].value.value(), 1e-8);
}

/// Displacements known along axes on sides, all else free.
class Supported final : public ElasticProblem<3> {
 public:
  explicit Supported(std::vector<SymmetryPlane> rollers) : rollers_(std::move(rollers)) {}
  const Domain<3>& domain() const override { return domain_; }
  Lame material(const Place<3>&) const override { return {2, 1}; }
  Known known(int field, int side) const override {
    for (const SymmetryPlane& roller : rollers_) {
      if (roller.side == side && roller.axis == field) return Known::value;
    }
    return Known::flux;
  }
  double given(int, int, const Point<3>&) const override { return 0; }
  std::vector<std::string> quantities() const override { return {}; }
  std::vector<double> measure(const Solution<3>&) const override { return {}; }

 private:
  UnitCube<3> domain_;
  std::vector<SymmetryPlane> rollers_;
};

/// Rank of the rows at a node that lies on sides with these normals, side 0 first, as equations
/// for three displacements and their nine slopes.
Eigen::Index rank_of_rows(const Supported& problem, const std::vector<Point<3>>& normals) {
  std::vector<BoundaryMark<3>> marks;
  marks.reserve(normals.size());
  for (const Point<3>& normal : normals) {
    marks.push_back({static_cast<int>(marks.size()), normal.normalized()});
  }
  const Derivatives<3> all = Derivatives<3>::between_orders(0, 1);
  EquationList list;
  EquationWriter<3> write(list, all);
  problem.boundary({0, Point<3>::Zero(), marks}, write);
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(list.size(), 3 * all.size());
  for (int r = 0; r < list.size(); ++r) {
    for (const Term& term : list.row(r)) {
      rows(r, 3 * term.derivative + term.field) += term.coefficient;
    }
  }
  return rows.colPivHouseholderQr().rank();
}

TEST(ElasticProblem, WritesIndependentRowsWhereFacesMeetSupports) {
  const Supported roller({{0, 0, 0}});
  EXPECT_EQ(rank_of_rows(roller, {{-1, 0, 0}, {0, 0, 1}}), 3);
  EXPECT_EQ(rank_of_rows(roller, {{-1, 0, 0}, {0, 1, 0}, {0, 0, 1}}), 3);
  // A face in the plane of the roller has its normal traction along the displacement given.
  EXPECT_EQ(rank_of_rows(roller, {{-1, 0, 0}, {-1, 0, 0}, {0, 0, 1}}), 3);
  EXPECT_EQ(rank_of_rows(roller, {{-1, 0, 0}, {-1, 0.1, 0}, {0, 0, 1}}), 3);
  // Faces that differ along the displacement given alone.
  EXPECT_EQ(rank_of_rows(roller, {{-1, 0, 0}, {1, 1, 0}, {-1, 1, 0}}), 3);
  const Supported rollers({{0, 0, 0}, {1, 1, 0}});
  EXPECT_EQ(rank_of_rows(rollers, {{-1, 0, 0}, {0, -1, 0}}), 3);
  EXPECT_EQ(rank_of_rows(rollers, {{-1, 0, 0}, {0, -1, 0}, {0, 0, 1}}), 3);
}

/// What graded_material is solved for, written out: displacements and moduli.
struct Graded {
  template <class T>
  std::array<T, 4> operator()(const std::array<T, 2>& x) const {
    return {sin(2.0 * x[0] + 1.0) * cos(1.5 * x[1]), cos(x[0] + 0.5) * sin(2.0 * x[1] + 0.5),
            2.0 + exp(x[0]) * cos(x[1]), 1.0 + 0.5 * sin(2.0 * x[0]) + 0.5 * x[1] * x[1]};
  }
};

/// A derivative of (u, v, p) at x, p = -lambda div u.
double exact_term(const std::array<Jet<2, 2>, 4>& jets, int field, const MultiIndex<2>& alpha) {
  if (field < 2) return jets[field].derivative(alpha);
  const double divergence = jets[0].derivative(partial<2>(0)) + jets[1].derivative(partial<2>(1));
  if (order_of<2>(alpha) == 0) return -jets[2].value() * divergence;
  const int j = alpha[0] > 0 ? 0 : 1;
  const double slope = jets[0].derivative(partial<2>(0, j)) + jets[1].derivative(partial<2>(1, j));
  return -jets[2].derivative(partial<2>(j)) * divergence - jets[2].value() * slope;
}

TEST(ElasticProblem, MeetsItsExactSolutionAtGhostsWhereTheMaterialVaries) {
  const NamedProblem named = make_problem("graded_material[unknowns=mixed]");
  const auto& problem = dynamic_cast<const SteadyProblem<2>&>(*std::get<1>(named.made));
  const PointCloud<2> cloud = unit_cloud<2>("grid", 5);
  const Derivatives<2> all = Derivatives<2>::between_orders(0, 2);
  for (int i = 0; i < cloud.size(); ++i) {
    const Node<2> node = node_of(cloud, i);
    if (!node.on(1) && !node.on(3)) continue;
    if (node.on(0) || node.on(2)) continue;  // held nodes have no ghost
    EquationList list;
    EquationWriter<2> write(list, all);
    problem.ghost(node, write);
    const auto jets = jets_at<2, 2>(Graded{}, node.x);
    ASSERT_EQ(list.size(), 3);
    for (int row = 0; row < 3; ++row) {
      double misfit = -list.right_hand_sides[row];
      for (const Term& term : list.row(row)) {
        misfit += term.coefficient * exact_term(jets, term.field, all[term.derivative]);
      }
      EXPECT_NEAR(misfit, 0, 1e-12) << "row " << row << " at " << format_point(node.x);
    }
  }
}

TEST(Assembly, NamesThePointOfARowBeyondThoseOfTheNodes) {
  Weights weights;
  weights.per_entry = 1;
  weights.offsets = {0, 1, 2};
  weights.columns = {0, 0};
  weights.values = {1, std::numeric_limits<double>::infinity()};
  EquationList equations;
  const Derivatives<1> derivatives{{1}};
  EquationWriter<1> write(equations, derivatives);
  for (int point : {0, 0, 1}) {
    write.at(point);
    write.add(0, {1}, 1);
    write.equals(1);
  }
  const std::string message =
      message_of<CaseError>([&] { assemble(equations, weights, {.count = 1}, 1); });
  expect_part(message, "row 2 of 3");
  expect_part(message, "evaluation point 1");
}

}  // namespace
}  // namespace strongpoint
