#include "problems/core/motion.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <Eigen/LU>
#include <gtest/gtest.h>
#include <omp.h>

#include "methods/core/error.hpp"
#include "problems/core/spectrum.hpp"
#include "studies/support/waves.hpp"
#include "tests/linear_systems.hpp"

namespace strongpoint {
namespace {

constexpr double round_off = 1e-12;  // of dense systems of a dozen unknowns, relative to 1

/// A system with inertia in some rows, and what condensation must make of it by dense algebra.
struct Case {
  Eigen::MatrixXd rows;    ///< unscaled
  Eigen::VectorXd data;    ///< unscaled right-hand sides
  Eigen::MatrixXd values;  ///< rows that give nodal values; the identity where unknowns are values
  std::vector<double> inertia;
  std::vector<int> moving, resting;
  LinearSystem system;
  LinearSystem value_system;
  enum class Unknowns { are_values, are_coefficients } unknowns;

  const LinearSystem* value_rows() const {
    return unknowns == Unknowns::are_values ? nullptr : &value_system;
  }
  CondensedMotion motion() const { return {system, inertia, value_rows()}; }

  /// x of [V_I; C] x = [top; bottom].
  Eigen::MatrixXd complete(const Eigen::MatrixXd& top, const Eigen::MatrixXd& bottom) const {
    Eigen::MatrixXd matrix(rows.rows(), rows.cols());
    matrix << values(moving, Eigen::all), rows(resting, Eigen::all);
    Eigen::MatrixXd right(rows.rows(), top.cols());
    right << top, bottom;
    return matrix.fullPivLu().solve(right);
  }
  /// A_I x - b over the inertia.
  Eigen::MatrixXd accelerations(const Eigen::MatrixXd& x, double load) const {
    Eigen::MatrixXd result = rows(moving, Eigen::all) * x;
    for (std::size_t i = 0; i < moving.size(); ++i) {
      result.row(static_cast<int>(i)).array() -= load * data[moving[i]];
      result.row(static_cast<int>(i)) /= inertia[moving[i]];
    }
    return result;
  }
  Eigen::MatrixXd expected_operator() const {
    const auto count = static_cast<Eigen::Index>(moving.size());
    return accelerations(
        complete(Eigen::MatrixXd::Identity(count, count),
                 Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(resting.size()), count)),
        0);
  }
};

void scale(LinearSystem& system, std::mt19937_64& generator) {
  system.row_scales.resize(system.rows());
  for (std::int64_t row = 0; row < system.rows(); ++row) {
    const double factor = 0.5 + uniform01(generator);
    system.row_scales[row] = factor;
    system.right_hand_side[row] *= factor;
    for (std::int64_t e = system.offsets[row]; e < system.offsets[row + 1]; ++e) {
      system.values[e] *= factor;
    }
  }
}

Case make_case(int fields, const std::vector<int>& moving, Case::Unknowns unknowns) {
  constexpr int count = 12;
  std::mt19937_64 generator(fields);
  Case made;
  made.unknowns = unknowns;
  made.rows = -dominant_matrix(count, 0.4, generator);
  made.data = random_vector(count, generator);
  made.values = unknowns == Case::Unknowns::are_values ? Eigen::MatrixXd::Identity(count, count)
                                                       : dominant_matrix(count, 0.3, generator);
  made.inertia.assign(count, 0);
  made.moving = moving;
  for (const int i : moving) made.inertia[i] = 0.5 + uniform01(generator);
  for (int i = 0; i < count; ++i) {
    if (made.inertia[i] == 0) made.resting.push_back(i);
  }
  made.system = system_of(made.rows, made.data, fields);
  scale(made.system, generator);
  made.value_system = system_of(made.values, Eigen::VectorXd::Zero(count), fields);
  scale(made.value_system, generator);
  return made;
}

std::vector<Case> all_cases() {
  std::vector<Case> cases;
  for (const auto unknowns : {Case::Unknowns::are_values, Case::Unknowns::are_coefficients}) {
    cases.push_back(make_case(1, {1, 2, 5, 6, 10}, unknowns));
    cases.push_back(make_case(2, {0, 1, 4, 5, 6, 7}, unknowns));
    cases.push_back(make_case(2, {0, 1, 3, 4, 5, 10}, unknowns));  // nodes that move in part
    cases.push_back(make_case(3, {3, 4, 5, 9, 10, 11}, unknowns));
    cases.push_back(make_case(1, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11}, unknowns));
  }
  return cases;
}

TEST(CondensedMotion, EqualsDenseElimination) {
  for (const Case& known : all_cases()) {
    const CondensedMotion motion = known.motion();
    ASSERT_EQ(motion.moving(), known.moving);
    EXPECT_LT((dense_operator(motion) - known.expected_operator()).cwiseAbs().maxCoeff(),
              round_off);
    const auto count = static_cast<Eigen::Index>(known.moving.size());
    const Eigen::MatrixXd loaded =
        known.complete(Eigen::VectorXd::Zero(count), known.data(known.resting));
    EXPECT_LT((motion.load() - known.accelerations(loaded, 1)).norm(), round_off);
  }
}

TEST(CondensedMotion, CompletesAllUnknownsFromMovingValuesAndData) {
  std::mt19937_64 generator(3);
  for (const Case& known : all_cases()) {
    const CondensedMotion motion = known.motion();
    const Eigen::VectorXd u = random_vector(motion.size(), generator);
    const Eigen::VectorXd expected = known.complete(u, -2.5 * known.data(known.resting));
    const Eigen::VectorXd unknowns = motion.all_unknowns(u, -2.5);
    EXPECT_LT((unknowns - expected).norm(), round_off);
    const Eigen::VectorXd values = known.values * unknowns;
    EXPECT_LT((motion.from_values(values) - u).norm(), round_off);
  }
}

/// All unknowns swing as x0 cos(omega t) when the data do, with what inertia asks of them in I.
TEST(CondensedMotion, KeepsAVibrationOfAllUnknownsUnderLoadsOfItsFrequency) {
  std::mt19937_64 generator(4);
  constexpr double square = 2.3;
  for (Case known : all_cases()) {
    const Eigen::VectorXd x = random_vector(static_cast<int>(known.rows.rows()), generator);
    const Eigen::VectorXd values = known.values * x;
    known.data = known.rows * x;
    for (const int i : known.moving) known.data[i] += square * known.inertia[i] * values[i];
    for (int i = 0; i < known.data.size(); ++i) {
      known.system.right_hand_side[i] = known.data[i] * known.system.row_scales[i];
    }
    const CondensedMotion motion = known.motion();
    const Eigen::VectorXd u = motion.from_values(values);
    Eigen::VectorXd acceleration(motion.size());
    motion.apply(u, acceleration);
    acceleration += motion.load();
    EXPECT_LT((acceleration + square * u).norm(), round_off);
    EXPECT_LT((motion.all_unknowns(u, 1) - x).norm(), round_off);
  }
}

TEST(CondensedMotion, SolvesShiftedSystems) {
  std::mt19937_64 generator(5);
  for (const Case& known : all_cases()) {
    const CondensedMotion motion = known.motion();
    const Eigen::MatrixXd matrix = dense_operator(motion);
    for (const double factor : {0.0, 1e-3, 2.0, -0.01}) {
      const Eigen::VectorXd x = random_vector(motion.size(), generator);
      const Eigen::VectorXd b = x - factor * matrix * x;
      Eigen::VectorXd solved(motion.size());
      motion.shifted(factor)->solve(b, solved);
      EXPECT_LT((solved - x).norm(), round_off);
    }
  }
}

TEST(CondensedMotion, RefusesSystemsThatDoNotMoveOrAreNotDetermined) {
  const Case known = make_case(1, {1, 2, 5, 6, 10}, Case::Unknowns::are_values);
  LinearSystem tall = known.system;
  tall.width = 11;
  EXPECT_NE(message_of<SkipCase>([&] {
              CondensedMotion(tall, known.inertia, nullptr);
            }).find("least squares"),
            std::string::npos);
  const std::vector<double> none(12, 0);
  EXPECT_NE(
      message_of<CaseError>([&] { CondensedMotion(known.system, none, nullptr); }).find("inertia"),
      std::string::npos);
}

/// Rows 7 and 8 say the same of the unknowns at rest, to `difference`.
std::string message_of_twins(double difference, Case::Unknowns unknowns) {
  Case known = make_case(1, {1, 2, 5, 6, 10}, unknowns);
  Eigen::MatrixXd rows = known.rows;
  rows.row(8) = rows.row(7) / 3;
  rows(8, 8) += difference;
  known.system = system_of(rows, known.data);
  known.system.row_scales.assign(12, 1);
  return message_of<CaseError>(
      [&] { CondensedMotion(known.system, known.inertia, known.value_rows()); });
}

TEST(CondensedMotion, NamesASingularBlockOfBoundaryConditions) {
  EXPECT_NE(message_of_twins(0, Case::Unknowns::are_values).find("the boundary conditions is"),
            std::string::npos);
  EXPECT_NE(message_of_twins(0, Case::Unknowns::are_coefficients).find("nodal values and"),
            std::string::npos);
  EXPECT_EQ(message_of_twins(1e-8, Case::Unknowns::are_values), "");
}

TEST(CondensedMotion, NamesAStepAtWhichTheShiftedMatrixIsSingular) {
  Eigen::MatrixXd rows = Eigen::MatrixXd::Identity(3, 3);
  rows(0, 0) = -4;
  LinearSystem system = system_of(rows, Eigen::VectorXd::Zero(3));
  system.row_scales.assign(3, 1);
  const CondensedMotion motion(system, {1, 0, 0}, nullptr);
  EXPECT_NE(message_of<CaseError>([&] { motion.shifted(-0.25); }).find("time step"),
            std::string::npos);
}

/// A problem of waves, discretised.
template <int Dim>
class Discretised {
 public:
  Discretised(const std::string& problem, const std::string& method, const std::string& stencil,
              int level)
      : problem_(make_problem(problem).made) {
    const CaseKey key{problem, method, stencil, "grid", "collocation", "umfpack", level};
    StageTimes times;
    const auto& waves = dynamic_cast<const TransientProblem<Dim>&>(
        *std::get<std::unique_ptr<Problem<Dim>>>(problem_));
    waves_ = make_waves<Dim>(waves, key, {}, times);
  }
  const CondensedMotion& motion() const { return *waves_.motion; }
  Eigen::VectorXd steady() const { return solve(waves_.system, "umfpack").x; }

 private:
  AnyProblem problem_;
  Waves<Dim> waves_;
};

/// |K u + f| / |f| at the solution of the equations in space, which stands still.
template <int Dim>
double unrest(const char* problem, const char* method, const char* stencil, int level) {
  const Discretised<Dim> waves(problem, method, stencil, level);
  const CondensedMotion& motion = waves.motion();
  const Eigen::VectorXd steady = waves.steady();
  Eigen::VectorXd u(motion.size());
  motion.shifted(1e9)->solve(Eigen::VectorXd(1e9 * motion.load()), u);
  EXPECT_LT((motion.all_unknowns(u, 1) - steady).norm(), 1e-6 * steady.norm())
      << problem << " " << method;
  Eigen::VectorXd acceleration(motion.size());
  motion.apply(u, acceleration);
  return (acceleration + motion.load()).norm() / motion.load().norm();
}

TEST(CondensedMotion, RestsAtTheSolutionOfTheEquationsInSpace) {
  // The end of the shift at 1e9 / (lowest omega)^2 and round-off of the solves.
  constexpr double tolerance = 1e-6;
  EXPECT_LT(unrest<1>("bar_1d", "mfpm", "nearest[k=3]", 51), tolerance);
  EXPECT_LT(unrest<1>("bar_1d", "mls", "nearest[k=5]", 51), tolerance);
  EXPECT_LT(unrest<2>("bar_2d[nu=0.3]", "lsfdm", "nearest[k=15]", 21), tolerance);
  EXPECT_LT(unrest<2>("bar_2d[nu=0.3]", "mls", "nearest[k=13]", 21), tolerance);
  EXPECT_LT(unrest<3>("bar_3d[nu=0.3]", "gfdm", "nearest[k=27]", 11), tolerance);
}

TEST(CondensedMotion, HasTheFrequenciesOfTheBarWithAndWithoutNodalValues) {
  for (const char* method : {"mfpm", "mls"}) {
    const Discretised<1> waves("bar_1d", method, "nearest[k=3]", 101);
    Eigen::VectorXd squares = -dense_eigenvalues(waves.motion()).real();
    std::sort(squares.data(), squares.data() + squares.size());
    for (int n = 1; n <= 5; ++n) {
      const double omega = (2 * n - 1) * std::numbers::pi / 2;
      // (omega h)^2 / 24 of the second difference at n = 5, and a little at the end.
      EXPECT_NEAR(std::sqrt(squares[n - 1]) / omega, 1, 2e-3) << method << " " << n;
    }
  }
}

TEST(CondensedMotion, GivesTheSameBitsOnOneThreadAndOnTwo) {
  const Discretised<2> waves("bar_2d", "lsfdm", "nearest[k=15]", 101);
  const CondensedMotion& motion = waves.motion();
  std::mt19937_64 generator(6);
  const Eigen::VectorXd u = random_vector(motion.size(), generator);
  std::array<Eigen::VectorXd, 2> products;
  const int before = omp_get_max_threads();
  for (int threads = 1; threads <= 2; ++threads) {
    omp_set_num_threads(threads);
    products[threads - 1].resize(motion.size());
    motion.apply(u, products[threads - 1]);
  }
  omp_set_num_threads(before);
  EXPECT_EQ(products[0], products[1]);
}

}  // namespace
}  // namespace strongpoint
