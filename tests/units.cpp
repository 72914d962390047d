// Units of stress and of length say nothing of whether a system can be solved, nor how well.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "problems/core/backward_error.hpp"
#include "problems/core/elastic_problem.hpp"
#include "studies/support/run_case.hpp"
#include "tests/linear_systems.hpp"

namespace strongpoint {
namespace {

void has(const std::string& message, const std::string& part) {
  EXPECT_NE(message.find(part), std::string::npos) << "'" << message << "' lacks '" << part << "'";
}

/// A modulus and a length, in whatever units.
struct Measures {
  double young = 1;
  double length = 1;
};

/// Steel in pascals and metres or millimetres, and the ends of what one may meet.
const std::vector<Measures> all_measures{{210e9, 1},   {210e9, 1e3}, {1e12, 1e-3}, {1e12, 1e3},
                                         {1e-6, 1e-3}, {1e-6, 1},    {1e-6, 1e3}};

enum class Held { at_an_end, nowhere };

/// A bar, clamped at its left end or floating, pulled and sheared at the right one by a thousandth
/// of its modulus.
template <int Dim>
class Bar final : public ElasticProblem<Dim> {
 public:
  Bar(const Measures& measures, Unknowns unknowns, Held held)
      : ElasticProblem<Dim>(unknowns),
        measures_(measures),
        held_(held),
        domain_(measures.length * (Point<Dim>::Ones() + Point<Dim>::Unit(0))) {}

  const Domain<Dim>& domain() const override { return domain_; }
  Lame material(const Place<Dim>&) const override { return lame_constants(measures_.young, 0.3); }
  Known known(int, int side) const override {
    return held_ == Held::at_an_end && is(side, "left") ? Known::value : Known::flux;
  }
  double given(int field, int side, const Point<Dim>&) const override {
    return is(side, "right") ? strain * measures_.young * (1 + field) : 0;
  }
  std::vector<std::string> quantities() const override { return {}; }
  /// Keeps the fields as numbers without a unit.
  std::vector<double> measure(const Solution<Dim>& solution) const override {
    fields_ = solution.fields;
    fields_.topRows(Dim) /= strain * measures_.length;
    if (this->is_mixed()) fields_.row(Dim) /= strain * measures_.young;
    return {};
  }
  /// (fields, nodes)
  const Eigen::MatrixXd& measured() const { return fields_; }

 private:
  static constexpr double strain = 1e-3;
  Measures measures_;
  Held held_;
  Box<Dim> domain_;
  mutable Eigen::MatrixXd fields_;

  bool is(int side, const char* name) const { return domain_.sides()[side] == name; }
};

/// A form with its solvers, and what is solved.
struct Scene {
  std::string form;
  std::string solver;
  Unknowns unknowns;
};

template <int Dim>
Eigen::MatrixXd solved(const Scene& scene, const Measures& measures, Held held = Held::at_an_end) {
  const Bar<Dim> bar(measures, scene.unknowns, held);
  const CaseKey key{"bar",
                    "lsfdm[weight=power[p=4]]",
                    Dim == 2 ? "nearest[k=15]" : "nearest[k=35]",
                    "perturbed",
                    scene.form,
                    scene.solver,
                    Dim == 2 ? 11 : 5};
  solve_steady<Dim>(bar, key, RunOptions{});
  return bar.measured();
}

template <int Dim>
void expect_the_same_in_all_units(const Scene& scene) {
  // Round-off times a condition of 1e4, or what a tolerance of 1e-9 leaves.
  const double tolerance = is_iterative(scene.solver) ? 1e-7 : 1e-11;
  const Eigen::MatrixXd expected = solved<Dim>(scene, {});
  for (const Measures& measures : all_measures) {
    const std::string name =
        fmt::format("{}d {} {} {} E {} L {}", Dim, scene.form, scene.solver,
                    static_cast<int>(scene.unknowns), measures.young, measures.length);
    try {
      const Eigen::MatrixXd found = solved<Dim>(scene, measures);
      for (int field = 0; field < found.rows(); ++field) {
        const double size = expected.row(field).lpNorm<Eigen::Infinity>();
        EXPECT_LT((found - expected).row(field).lpNorm<Eigen::Infinity>(), tolerance * size)
            << name << " field " << field;
      }
    } catch (const CaseError& error) {
      ADD_FAILURE() << name << ": " << error.what();
    }
  }
}

const std::vector<std::string> direct{
    "umfpack", "umfpack[ordering=metis]", "frontal", "mumps", "dense_lu", "sparse_lu", "spqr",
    "normal"};

TEST(Units, ChangeNoSolutionOfAPlane) {
  std::vector<std::string> solvers = direct;
  solvers.insert(solvers.end(), {"bicgstab", "gmres[precond=ilu0]", "idr", "auto"});
  for (const std::string& solver : solvers) {
    for (const Unknowns unknowns : {Unknowns::displacement, Unknowns::mixed}) {
      expect_the_same_in_all_units<2>({"collocation[boundary=ghost]", solver, unknowns});
    }
  }
  expect_the_same_in_all_units<2>({"flux", "umfpack", Unknowns::mixed});
}

TEST(Units, ChangeNoSolutionInSpace) {
  for (const char* solver : {"umfpack", "bicgstab"}) {
    expect_the_same_in_all_units<3>({"collocation[boundary=ghost]", solver, Unknowns::mixed});
  }
}

TEST(Units, LetNoBodyFloat) {
  for (const std::string& solver : direct) {
    for (const Unknowns unknowns : {Unknowns::displacement, Unknowns::mixed}) {
      const Scene scene{"collocation[boundary=ghost]", solver, unknowns};
      for (const Measures& measures : all_measures) {
        const std::string message =
            message_of<CaseError>([&] { solved<2>(scene, measures, Held::nowhere); });
        has(message, fmt::format("{}: the system of ", solver.substr(0, solver.find('['))));
        // The pivots of normal equations cannot tell.
        if (solver != "normal") has(message, "is singular; check the boundary conditions");
      }
    }
  }
}

/// What solves A x = b, with rows and fields in units of their own.
struct Example {
  Eigen::MatrixXd matrix;
  Eigen::VectorXd x;
  int fields;

  LinearSystem system() const { return system_of(matrix, matrix * x, fields); }
  void change_units(double row, double field) {
    for (Eigen::Index i = 0; i < matrix.rows(); i += 3) matrix.row(i) *= row;
    for (Eigen::Index j = fields - 1; j < x.size(); j += fields) {
      matrix.col(j) /= field;
      x[j] *= field;
    }
  }
};

Example example(int rows, int unknowns, int fields) {
  std::mt19937_64 generator(7);
  Eigen::MatrixXd matrix = sparse_matrix(rows, unknowns, 0.3, generator);
  matrix.diagonal().array() += 2;
  return {matrix, random_vector(unknowns, generator), fields};
}

double error_of(const LinearSystem& system, const Eigen::VectorXd& x) {
  const FieldUnits units(system);
  Eigen::VectorXd residual;
  return BackwardError(system, units).of(x, residual);
}

TEST(BackwardError, IsThatOfTheWorstRow) {
  const LinearSystem system = system_of(Eigen::Matrix2d{{2, 1}, {0, 4}}, Eigen::Vector2d(3, 8));
  // Residuals 3 - 2 - 3 and 8 - 12 against 3 + 3 * 3 and 8 + 4 * 3.
  EXPECT_DOUBLE_EQ(error_of(system, Eigen::Vector2d(1, 3)), 4.0 / 20);
  EXPECT_EQ(error_of(system, Eigen::Vector2d(0.5, 2)), 0);
  EXPECT_EQ(error_of(system, Eigen::Vector2d(0.5, std::nan(""))),
            std::numeric_limits<double>::infinity());
}

TEST(BackwardError, SeesWhatIsWrongBesideLargeNumbers) {
  Example wrong = example(60, 60, 2);
  LinearSystem system = wrong.system();
  wrong.x[0] += 1e-3;
  const double error = error_of(system, wrong.x);
  EXPECT_GT(error, 1e-5);
  Example other = example(60, 60, 2);
  constexpr double unit = 0x1p40;
  other.change_units(0x1p-20, unit);
  system = other.system();
  other.x[0] += 1e-3;
  EXPECT_NEAR(error_of(system, other.x), error, 1e-12 * error);
}

double error_as_null_vector(const LinearSystem& system, const Eigen::VectorXd& x) {
  const FieldUnits units(system);
  return BackwardError(system, units).of_null_vector(x);
}

TEST(BackwardError, TellsANullVectorOfAllFieldsOrOfOne) {
  constexpr double tiny = 0x1p-50;
  const Eigen::Matrix2d close{{1, -1}, {1, -1 + tiny}};
  const LinearSystem both = system_of(close, Eigen::Vector2d(0, tiny), 2);
  EXPECT_LE(error_as_null_vector(both, Eigen::Vector2d(1, 1)), tiny);
  EXPECT_EQ(error_as_null_vector(both, Eigen::Vector2d(0, 0)),
            std::numeric_limits<double>::infinity());
  // The first field is given, the second as above.
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
  matrix(Eigen::seqN(1, 2, 2), Eigen::seqN(1, 2, 2)) = close;
  const LinearSystem one = system_of(matrix, Eigen::Vector4d(1, 1, 2, 2), 2);
  EXPECT_LE(error_as_null_vector(one, Eigen::Vector4d(1, 1 / tiny, 2, 1 / tiny)), 2 * tiny);
  // A unit is no fault.
  matrix = Eigen::Vector4d(1, tiny, 1, tiny).asDiagonal();
  const LinearSystem small = system_of(matrix, Eigen::Vector4d::Ones(), 2);
  EXPECT_EQ(error_as_null_vector(small, Eigen::Vector4d(1, 1 / tiny, 1, 1 / tiny)), 1);
}

TEST(FieldUnits, OfAVectorsComponentsAreOne) {
  LinearSystem system = example(30, 30, 3).system();
  EXPECT_EQ(FieldUnits(system).count(), 3);
  system.field_axis = {0, 1, -1};
  const FieldUnits units(system);
  EXPECT_EQ(units.count(), 2);
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(30, 1, 30);
  EXPECT_EQ(units.sizes(x), Eigen::Vector2d(29, 30));
}

TEST(FieldUnits, AreEvenWhereSumsAreOfOneSize) {
  Example changed = example(60, 60, 2);
  const Eigen::VectorXd as_is = FieldUnits(changed.system()).even_sizes();
  EXPECT_EQ(as_is, Eigen::Vector2d(1, 1));
  constexpr double unit = 0x1p40;
  changed.change_units(0x1p-20, unit);
  const LinearSystem system = changed.system();
  const FieldUnits units(system);
  EXPECT_EQ(units.even_sizes(), Eigen::Vector2d(1, unit));
  EXPECT_EQ(FieldUnits(in_units(system, units, units.even_sizes())).even_sizes(), as_is);
}

TEST(LeastSquares, TakesFieldsOfAllUnits) {
  for (const char* solver : {"spqr", "normal"}) {
    Example known = example(90, 40, 2);
    constexpr double unit = 0x1p45;
    known.change_units(1, unit);
    LinearSystem system = known.system();
    std::mt19937_64 generator(8);
    system.right_hand_side += random_vector(90, generator);  // no solution
    Eigen::VectorXd x = solve(system, solver).x;
    for (Eigen::Index j = 1; j < x.size(); j += 2) x[j] /= unit;
    const Eigen::MatrixXd matrix = example(90, 40, 2).matrix;
    const Eigen::VectorXd expected = matrix.householderQr().solve(system.right_hand_side);
    EXPECT_LT((x - expected).norm(), 1e-12 * expected.norm()) << solver;
  }
}

/// Components that are zero but for round-off or what an iteration leaves have the unit of others.
TEST(Units, OfAComponentThatIsZeroAreThoseOfTheOthers) {
  Eigen::Matrix2d matrix{{1, 0}, {1e-3, 1}};
  LinearSystem system = system_of(matrix, Eigen::Vector2d(1, 0), 2);
  EXPECT_GT(error_of(system, Eigen::Vector2d(1, -1e-3 + 1e-9)), 1e-10);
  matrix(1, 0) = 0;
  system = system_of(matrix, Eigen::Vector2d(1, 0), 2);
  EXPECT_EQ(error_of(system, Eigen::Vector2d(1, 1e-15)), 1);
  system.field_axis = {0, 1};
  EXPECT_EQ(error_of(system, Eigen::Vector2d(1, 1e-15)), 1e-15);
}

}  // namespace
}  // namespace strongpoint
