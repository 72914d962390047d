#include "problems/core/symbol.hpp"

#include <numbers>

#include <gtest/gtest.h>

#include "methods/core/error.hpp"
#include "problems/core/elasticity.hpp"
#include "problems/core/wave_branches.hpp"
#include "studies/support/node_symbols.hpp"
#include "studies/support/waves.hpp"

namespace strongpoint {
namespace {

using Complex = std::complex<double>;

constexpr double pi = std::numbers::pi;
/// Round-off of sums over a stencil, relative to their largest terms.
constexpr double round_off = 1e-11;

CaseKey key_of(const std::string& problem, const std::string& method, const std::string& stencil,
               const std::string& cloud, int level) {
  return {problem, method, stencil, cloud, "collocation", "umfpack", level};
}

template <int Dim>
WaveSymbols<Dim> symbols_of(const CaseKey& key, int count = 1) {
  return with_problem<TransientProblem>(
      key.problem, "transient", [&]<int D>(const TransientProblem<D>& problem) {
        if constexpr (D == Dim) return node_symbols<Dim>(problem, key, count, RunOptions{});
        throw std::logic_error("the problem has another dimension");
        return symbols_of<Dim>(key);
      });
}

WaveSymbols<1> line(const std::string& method, int k) {
  return symbols_of<1>(
      key_of("bar_1d", method, "nearest[k=" + std::to_string(k) + "]", "grid", 101));
}

const Point<1> rightwards(1.0);

/// The only branch in 1D at a wavenumber times the spacing over pi.
Branch wave_in(const WaveSymbols<1>& line, double wave) {
  return branches<1>(line.nodes[0], line.exact, Point<1>(wave * pi / line.spacing), rightwards)[0];
}

TEST(Symbol, ThreePointsGiveTwiceTheSineOfHalfThePhase) {
  const WaveSymbols<1> bar = line("mfpm", 3);
  ASSERT_NEAR(bar.spacing, 0.01, 1e-15);
  for (const double wave : {0.1, 0.37, 0.8, 0.99}) {
    const double half = wave * pi / 2;
    const Branch branch = wave_in(bar, wave);
    EXPECT_NEAR(branch.exact, wave * pi / 0.01, round_off * branch.exact);
    const Frequency found = frequency(branch.eigenvalue, {});
    EXPECT_NEAR(found.omega.real(), 2 / 0.01 * std::sin(half), round_off * 200);
    EXPECT_EQ(found.omega.imag(), 0);
    const Complex group = *found.per_eigenvalue * *branch.slope;
    EXPECT_NEAR(group.real(), std::cos(half), round_off * 100);
  }
}

/// omega / xi with central differences of step 1e-5 at xi h / pi = .1, .3, .5, .7, 1, four digits.
TEST(Symbol, PairsOfProjectionsDisperseAsKnown) {
  const auto check = [](const std::string& method, int k, const std::array<double, 5>& known) {
    const WaveSymbols<1> bar = line(method, k);
    const std::array<double, 5> waves{0.1, 0.3, 0.5, 0.7, 1};
    for (std::size_t i = 0; i < waves.size(); ++i) {
      const Branch branch = wave_in(bar, waves[i]);
      const double ratio = frequency(branch.eigenvalue, 1e-5).omega.real() / branch.exact;
      EXPECT_NEAR(ratio, known[i], 0.51e-4) << method << " at " << waves[i];
    }
  };
  check("mfpm", 3, {0.9959, 0.9634, 0.9003, 0.8103, 0.6366});
  check("mfpm[projection=linear+quadratic]", 5, {0.9844, 0.8649, 0.6551, 0.4074, 0.1544});
  check("mfpm[projection=constant+linear]", 5, {0.9861, 0.8804, 0.6974, 0.4895, 0.2847});
}

TEST(Symbol, FrequenciesUnderCentralDifferencesAreTheArcCosine) {
  const double dt = 0.1;
  for (const Complex lambda : {Complex(-30, 0), Complex(-30, 8), Complex(-300, -20)}) {
    const Frequency found = frequency(lambda, dt);
    const Complex known = std::acos(1.0 + dt * dt / 2 * lambda) / dt;
    EXPECT_NEAR(std::abs(found.omega - known), 0, 1e-12 * std::abs(known)) << lambda;
    const Complex step(1e-4, 1e-4);
    const Complex slope =
        (frequency(lambda + step, dt).omega - frequency(lambda - step, dt).omega) / (2.0 * step);
    EXPECT_NEAR(std::abs(*found.per_eigenvalue - slope), 0, 1e-8) << lambda;
  }
  const Frequency beyond = frequency(-5 / (dt * dt), dt);  // 1 + dt^2 lambda / 2 = -1.5
  EXPECT_NEAR(beyond.omega.real(), pi / dt, 1e-12 / dt);
  EXPECT_NEAR(beyond.omega.imag(), -std::acosh(1.5) / dt, 1e-12 / dt);
  EXPECT_NEAR(frequency(9, {}).omega.imag(), -3, 1e-15);
  EXPECT_FALSE(frequency(0, {}).per_eigenvalue);
}

/// Symbols of the second derivatives over h^2 at the phases a, b along x and y.
struct SecondDerivatives {
  double xx, xy, yy;
};

/// S of plane strain from them.
FieldMatrix<Complex> elastic(const SecondDerivatives& d, double h, double nu) {
  const Lame material = lame_constants(100, nu);
  const double density = 100;
  const double shear = (material.lambda + material.mu) * d.xy;
  const double press = material.lambda + 2 * material.mu;
  FieldMatrix<Complex> matrix(2, 2);
  matrix << press * d.xx + material.mu * d.yy, shear, shear, material.mu * d.xx + press * d.yy;
  return matrix / (density * h * h);
}

template <class KnownSymbol>
void expect_symbol(const std::string& method, KnownSymbol&& known) {
  const WaveSymbols<2> bar =
      symbols_of<2>(key_of("bar_2d[nu=0.3]", method, "nearest[k=9]", "grid", 41));
  const double h = bar.spacing;
  ASSERT_NEAR(h, 1.0 / 40, 1e-15);
  for (const auto& [a, b] : {std::pair{0.3, 0.2}, {-1.1, 2.0}, {3.0, 0.0}, {2.2, 2.2}}) {
    const auto found = bar.nodes[0].at(Point<2>(a / h, b / h));
    const FieldMatrix<Complex> expected = elastic(known(a, b), h, 0.3);
    EXPECT_NEAR((*found - expected).norm(), 0, round_off * bar.nodes[0].scale()) << method;
  }
}

/// Quadratic fits by nine nodes that pass through the middle one, worked out by hand: with the
/// sums over the eight others of x^4 = 6, x^2 y^2 = 4 and x y x y = 4, u_xx = (6 sum x^2 du - 4 sum
/// y^2 du) / 10 and u_xy = sum x y du / 4.
TEST(Symbol, NineNodesOfAGridAreTheFitWorkedOutByHand) {
  expect_symbol("mfpm", [](double a, double b) {
    const double both = 0.8 * std::cos(a) * std::cos(b) - 1.2;
    return SecondDerivatives{both + 1.2 * std::cos(a) - 0.8 * std::cos(b),
                             -std::sin(a) * std::sin(b),
                             both + 1.2 * std::cos(b) - 0.8 * std::cos(a)};
  });
}

TEST(Symbol, FiniteDifferencesAreThoseOfTextbooks) {
  expect_symbol("fdm", [](double a, double b) {
    return SecondDerivatives{2 * std::cos(a) - 2, -std::sin(a) * std::sin(b), 2 * std::cos(b) - 2};
  });
}

/// Largest relative difference of the eigenvalues from the exact ones at a wavenumber.
template <int Dim>
double error_at(const WaveSymbols<Dim>& symbols, const Point<Dim>& direction, double wave) {
  double worst = 0;
  const Point<Dim> xi = direction * (wave * pi / symbols.spacing);
  for (const Branch& branch : branches<Dim>(symbols.nodes[0], symbols.exact, xi, direction)) {
    const double exact = branch.exact * branch.exact;
    worst = std::max(worst, std::abs(branch.eigenvalue + exact) / exact);
  }
  return worst;
}

/// log2 of the error's fall when waves become twice as long.
template <int Dim>
double order_of_waves(const CaseKey& key, const Point<Dim>& direction) {
  const WaveSymbols<Dim> symbols = symbols_of<Dim>(key);
  return std::log2(error_at<Dim>(symbols, direction, 0.05) /
                   error_at<Dim>(symbols, direction, 0.025));
}

TEST(Symbol, LongWavesAreRightAtTheOrderOfTheStencil) {
  const Point<2> plane = Point<2>(0.8, 0.6);
  const Point<3> space = Point<3>(0.48, 0.64, 0.6);
  for (const char* method : {"mfpm", "gfdm", "lsfdm", "mls", "rbf_fd"}) {
    const double order =
        order_of_waves<2>(key_of("bar_2d[nu=0.3]", method, "nearest[k=13]", "grid", 41), plane);
    EXPECT_NEAR(order, 2, 0.1) << method;
  }
  EXPECT_NEAR(
      order_of_waves<3>(key_of("bar_3d[nu=0.3]", "lsfdm", "nearest[k=33]", "grid", 21), space), 2,
      0.1);
  // Irregular stencils lose the order that symmetry gives.
  EXPECT_NEAR(
      order_of_waves<2>(key_of("bar_2d", "lsfdm", "nearest[k=15]", "perturbed[seed=2]", 41), plane),
      1, 0.15);
}

TEST(Symbol, CellBalancesMoveLongWavesAsPointsDo) {
  CaseKey key = key_of("bar_2d[nu=0.3]", "lsfdm", "nearest[k=15]", "grid", 41);
  key.form = "flux";  // inertia is that of cells
  const Point<2> direction(0.8, 0.6);
  EXPECT_LT(error_at<2>(symbols_of<2>(key), direction, 0.02), 1e-2);
  EXPECT_GT(order_of_waves<2>(key, direction), 0.9);
}

TEST(Symbol, SymmetricStencilsHaveRealSymbolsAndOthersDoNot) {
  for (const char* cloud : {"grid", "perturbed[seed=1]"}) {
    const WaveSymbols<2> bar = symbols_of<2>(key_of("bar_2d", "lsfdm", "nearest[k=21]", cloud, 41));
    const auto symbol = bar.nodes[0].at(Point<2>(0.7, 1.1) / bar.spacing);
    const double imaginary = symbol->imag().norm() / bar.nodes[0].scale();
    if (cloud == std::string("grid")) {
      EXPECT_LT(imaginary, round_off);
    } else {
      EXPECT_GT(imaginary, 1e-4);
    }
  }
}

TEST(Symbol, SlopesAreDerivativesOfEigenvalues) {
  for (const char* method : {"mfpm", "mls"}) {  // mls does not interpolate
    const WaveSymbols<2> bar =
        symbols_of<2>(key_of("bar_2d[nu=0.3]", method, "nearest[k=15]", "perturbed[seed=3]", 41));
    const Point<2> direction(0.28, 0.96);
    const double size = 0.6 * pi / bar.spacing;
    const double step = 1e-5 * size;
    const auto at = [&](double k) {
      return branches<2>(bar.nodes[0], bar.exact, k * direction, direction);
    };
    for (std::size_t b = 0; b < 2; ++b) {
      const Complex differences =
          (at(size + step)[b].eigenvalue - at(size - step)[b].eigenvalue) / (2 * step);
      const Complex slope = *at(size)[b].slope;
      EXPECT_NEAR(std::abs(slope - differences), 0, 1e-7 * std::abs(slope)) << method;  // step^2
    }
  }
}

/// The condensed operator of the whole system, which knows nothing of symbols, applied to a wave.
TEST(Symbol, TheOperatorMakesOfAWaveWhatTheSymbolSays) {
  const CaseKey key = key_of("bar_2d[nu=0.3]", "lsfdm", "nearest[k=15]", "perturbed[seed=1]", 41);
  with_problem<TransientProblem>(
      key.problem, "transient", [&]<int Dim>(const TransientProblem<Dim>& problem) {
        StageTimes times;
        const RunOptions options;
        const Waves<Dim> waves = make_waves<Dim>(problem, key, options, times);
        const WaveSymbols<Dim> symbols = node_symbols<Dim>(problem, key, 1, options);
        const PointCloud<Dim>& cloud = waves.scene->cloud;
        Eigen::Index node = 0;
        (cloud.nodes.colwise() - problem.domain().map(Point<Dim>::Constant(0.5)))
            .colwise()
            .squaredNorm()
            .minCoeff(&node);
        Point<Dim> xi = Point<Dim>::Constant(0.4 / symbols.spacing);
        xi[0] *= -2;
        const std::vector<int>& moving = waves.motion->moving();
        for (int field = 0; field < Dim; ++field) {
          Eigen::VectorXd real = Eigen::VectorXd::Zero(waves.motion->size());
          Eigen::VectorXd imaginary = real;
          for (std::size_t i = 0; i < moving.size(); ++i) {
            if (moving[i] % Dim != field) continue;
            const double phase = -xi.dot(cloud.nodes.col(moving[i] / Dim) - cloud.nodes.col(node));
            real[static_cast<Eigen::Index>(i)] = std::cos(phase);
            imaginary[static_cast<Eigen::Index>(i)] = std::sin(phase);
          }
          Eigen::VectorXd of_real(real.size());
          Eigen::VectorXd of_imaginary(real.size());
          waves.motion->apply(real, of_real);
          waves.motion->apply(imaginary, of_imaginary);
          for (std::size_t i = 0; i < moving.size(); ++i) {
            if (moving[i] / Dim != node) continue;
            const auto row = static_cast<Eigen::Index>(i);
            const Complex known = (*symbols.nodes[0].at(xi))(moving[i] % Dim, field);
            EXPECT_NEAR(std::abs(Complex(of_real[row], of_imaginary[row]) - known), 0,
                        round_off * symbols.nodes[0].scale());
          }
        }
      });
}

TEST(Symbol, FastAndSlowWavesKeepTheirNamesInAllDirections) {
  for (const char* nu : {"0", "0.3", "0.49"}) {
    const WaveSymbols<2> bar = symbols_of<2>(
        key_of(std::string("bar_2d[nu=") + nu + "]", "lsfdm", "nearest[k=15]", "grid", 41));
    const Lame material = lame_constants(100, std::stod(nu));
    for (int i = 0; i < 24; ++i) {
      const Point<2> direction(std::cos(i * pi / 24), std::sin(i * pi / 24));
      const auto found =
          branches<2>(bar.nodes[0], bar.exact, 0.05 * pi / bar.spacing * direction, direction);
      const double size = 0.05 * pi / bar.spacing;
      EXPECT_NEAR(found[0].exact / size, std::sqrt((material.lambda + 2 * material.mu) / 100),
                  1e-9);
      EXPECT_NEAR(found[1].exact / size, std::sqrt(material.mu / 100), 1e-9);
      for (const Branch& branch : found) {
        EXPECT_NEAR(std::sqrt(-branch.eigenvalue).real() / branch.exact, 1, 0.03);
      }
    }
  }
}

TEST(Symbol, ProblemsThatAreNoWavesAreRefused) {
  EXPECT_THROW(symbols_of<2>(key_of("poisson_square", "mfpm", "nearest[k=9]", "grid", 11)),
               SkipCase);
}

}  // namespace
}  // namespace strongpoint
