#include <algorithm>
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

/// The numbers of a state, end to end.
Eigen::VectorXd numbers_of(const MotionState& state) {
  Eigen::VectorXd all(state.displacement.size() + state.velocity.size() +
                      state.acceleration.size());
  all << state.displacement, state.velocity, state.acceleration;
  return all;
}

}  // namespace

double amplification(std::string_view spec, std::complex<double> lambda, const Damping& damping,
                     double node_time, double dt) {
  const ScalarMotion motion(lambda);
  const DampedMotion damped(motion, damping, node_time);
  const LoadHistory none = [](double) { return 0.0; };
  const std::unique_ptr<Integrator> integrator = make_integrator(spec, {damped, none, dt});
  MotionState first;
  first.displacement = first.velocity = Eigen::VectorXd::Zero(2);
  integrator->start(first);
  const Eigen::Index size = numbers_of(first).size();
  Eigen::MatrixXd step(size, size);
  for (Eigen::Index j = 0; j < size; ++j) {
    MotionState state = first;
    Eigen::VectorXd unit = Eigen::VectorXd::Unit(size, j);
    state.displacement = unit.head(2);
    state.velocity = unit.segment(2, 2);
    if (size > 4) state.acceleration = unit.tail(size - 4);
    integrator->advance(state);
    step.col(j) = numbers_of(state);
  }
  return step.eigenvalues().cwiseAbs().maxCoeff();
}

double stable_step(std::string_view spec, double spectral_radius, const Damping& damping,
                   double node_time) {
  // A double eigenvalue on the unit circle, as undamped integrators have at their limit, is
  // computed to the square root of round-off.
  constexpr double tolerance = 1e-6;
  const auto is_stable = [&](double dt) {
    constexpr int samples = 64;  // damping may bite first at frequencies below the highest
    for (int i = 1; i <= samples; ++i) {
      const double lambda = -spectral_radius * i / samples;
      if (!(amplification(spec, lambda, damping, node_time, dt) <= 1 + tolerance)) return false;
    }
    return true;
  };
  double longest = 1e3 / std::sqrt(spectral_radius);
  if (is_stable(longest)) return std::numeric_limits<double>::infinity();
  double stable = 0;
  for (int i = 0; i < 40; ++i) {
    const double middle = (stable + longest) / 2;
    (is_stable(middle) ? stable : longest) = middle;
  }
  return stable;
}

}  // namespace strongpoint
