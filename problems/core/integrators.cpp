#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <Eigen/Eigenvalues>
#include <fmt/format.h>

#include "methods/core/error.hpp"
#include "problems/core/integrator.hpp"

namespace strongpoint {

#define INTEGRATOR(name) IntegratorEntry integrator_##name();
#include "problems/core/integrators/integrators.def"
#undef INTEGRATOR

const std::vector<IntegratorEntry>& integrators() {
  static const std::vector<IntegratorEntry> all = [] {
    std::vector<IntegratorEntry> entries{
#define INTEGRATOR(name) integrator_##name(),
#include "problems/core/integrators/integrators.def"
#undef INTEGRATOR
    };
    for (IntegratorEntry& entry : entries) {
      entry.info.options.push_back({"dt", "", "time step; the problem's own if not given"});
      entry.info.options.push_back(
          {"courant", "", "time step over the time that a wave takes from node to node"});
    }
    return entries;
  }();
  return all;
}

TimeSpec parse_time(std::string_view text) {
  const Spec spec = parse_spec(text);
  const IntegratorEntry& entry = find_entry(integrators(), "time integrator", spec.name);
  const Options options(entry.info, spec);
  TimeSpec time{options.canonical(), {}, {}, entry.is_explicit};
  constexpr double largest = 1e6;
  if (options.has("dt")) time.dt = options.number("dt", 1e-12, largest);
  if (options.has("courant")) time.courant = options.number("courant", 1e-9, largest);
  if (time.dt && time.courant) {
    throw UsageError(fmt::format("{}: dt and courant both say how long a step is; give one",
                                 options.canonical()));
  }
  Amplification{text}(-1, {}, 1, 1);  // refuses values that do not fit
  return time;
}

std::unique_ptr<Integrator> make_integrator(std::string_view text, const Integration& integration) {
  const Spec spec = parse_spec(text);
  const IntegratorEntry& entry = find_entry(integrators(), "time integrator", spec.name);
  return entry.make(Options(entry.info, spec), integration);
}

namespace {

/// u'' = lambda u with a complex lambda, in real and imaginary parts.
class ScalarMotion final : public Motion {
 public:
  explicit ScalarMotion(std::complex<double> lambda) {
    matrix_ << lambda.real(), -lambda.imag(), lambda.imag(), lambda.real();
  }
  int size() const override { return 2; }
  void apply(const Eigen::VectorXd& u, Eigen::VectorXd& product) const override {
    product.noalias() = matrix_ * u;
  }
  const Eigen::VectorXd& load() const override { return load_; }
  std::unique_ptr<ShiftedMotion> shifted(double factor) const override {
    return std::make_unique<Inverse>(Eigen::Matrix2d::Identity() - factor * matrix_);
  }

 private:
  class Inverse final : public ShiftedMotion {
   public:
    explicit Inverse(const Eigen::Matrix2d& matrix) : inverse_(matrix.inverse()) {}
    void solve(const Eigen::VectorXd& b, Eigen::VectorXd& x) const override {
      x.noalias() = inverse_ * b;
    }

   private:
    Eigen::Matrix2d inverse_;
  };
  Eigen::Matrix2d matrix_;
  Eigen::VectorXd load_ = Eigen::VectorXd::Zero(2);
};

/// One step for the displacement, the velocity and what else a state carries, as a complex matrix
/// in units in which dt is 1.
template <int Size>
using StepMatrix = Eigen::Matrix<std::complex<double>, Size, Size>;

/// The number of a state at a place: displacement, velocity, acceleration.
Eigen::VectorXd& part(MotionState& state, int place) {
  return place == 0 ? state.displacement : place == 1 ? state.velocity : state.acceleration;
}

template <int Size>
StepMatrix<Size> step_matrix(Integrator& integrator, const MotionState& first, double dt) {
  const std::array<double, 3> units{1, 1 / dt, 1 / (dt * dt)};
  StepMatrix<Size> matrix;
  MotionState state = first;
  for (int j = 0; j < Size; ++j) {
    for (int i = 0; i < Size; ++i) part(state, i).setZero();
    part(state, j)[0] = units[j];
    integrator.advance(state);
    for (int i = 0; i < Size; ++i) {
      matrix(i, j) = std::complex<double>(part(state, i)[0], part(state, i)[1]) / units[i];
    }
  }
  return matrix;
}

double spectral_radius(const StepMatrix<2>& step) {
  const std::complex<double> mean = step.trace() / 2.0;
  const std::complex<double> half_gap = std::sqrt(mean * mean - step.determinant());
  return std::max(std::abs(mean + half_gap), std::abs(mean - half_gap));
}

double spectral_radius(const StepMatrix<3>& step) {
  const Eigen::ComplexEigenSolver<StepMatrix<3>> solver(step, /*computeEigenvectors=*/false);
  if (solver.info() != Eigen::Success) return std::numeric_limits<double>::infinity();
  return solver.eigenvalues().cwiseAbs().maxCoeff();
}

}  // namespace

Amplification::Amplification(std::string_view text) : Amplification(parse_spec(text)) {}

Amplification::Amplification(const Spec& spec)
    : entry_(find_entry(integrators(), "time integrator", spec.name)),
      options_(entry_.info, spec) {}

double Amplification::operator()(std::complex<double> lambda, const Damping& damping,
                                 double node_time, double dt) const {
  const ScalarMotion motion(lambda);
  const DampedMotion damped(motion, damping, node_time);
  static const LoadHistory none = [](double) { return 0.0; };
  const std::unique_ptr<Integrator> integrator = entry_.make(options_, {damped, none, dt});
  MotionState first;
  first.displacement = first.velocity = Eigen::VectorXd::Zero(2);
  integrator->start(first);
  const double growth = first.acceleration.size() == 0
                            ? spectral_radius(step_matrix<2>(*integrator, first, dt))
                            : spectral_radius(step_matrix<3>(*integrator, first, dt));
  return std::isnan(growth) ? std::numeric_limits<double>::infinity() : growth;
}

double Amplification::stable_step(double spectral_radius, const Damping& damping,
                                  double node_time) const {
  // A double eigenvalue on the unit circle, as undamped integrators have at their limit, is
  // computed to the square root of round-off.
  constexpr double tolerance = 1e-6;
  const auto is_stable = [&](double dt) {
    constexpr int samples = 64;  // damping may bite first at frequencies below the highest
    for (int i = samples; i >= 1; --i) {
      const double lambda = -spectral_radius * i / samples;
      if (!((*this)(lambda, damping, node_time, dt) <= 1 + tolerance)) return false;
    }
    return true;
  };
  if (!(spectral_radius > 0)) return std::numeric_limits<double>::infinity();
  double unstable = 1e3 / std::sqrt(spectral_radius);
  if (is_stable(unstable)) return std::numeric_limits<double>::infinity();
  double stable = 0;
  constexpr double precision = 1e-9;
  constexpr int halvings = 200;  // far below any step that a run could take
  for (int i = 0; i < halvings && unstable - stable > precision * unstable; ++i) {
    const double middle = (stable + unstable) / 2;
    (is_stable(middle) ? stable : unstable) = middle;
  }
  return stable;
}

double amplification(std::string_view spec, std::complex<double> lambda, const Damping& damping,
                     double node_time, double dt) {
  return Amplification(spec)(lambda, damping, node_time, dt);
}

double stable_step(std::string_view spec, double spectral_radius, const Damping& damping,
                   double node_time) {
  return Amplification(spec).stable_step(spectral_radius, damping, node_time);
}

}  // namespace strongpoint
