#pragma once

#include <complex>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "problems/core/damping.hpp"

namespace strongpoint {

/// What a time integrator carries from step to step; a run continues from it to the same bits.
struct MotionState {
  std::int64_t step = 0;
  Eigen::VectorXd displacement;  ///< (size) at the time of the step
  Eigen::VectorXd velocity;      ///< (size) at that time, or half a step before with `central`
  Eigen::VectorXd acceleration;  ///< (size) of integrators that keep it, else empty
};

/// Factor of the data at a time.
using LoadHistory = std::function<double(double)>;

/// Advances a motion by steps of one length; step n ends at the time n * dt.
class Integrator {
 public:
  Integrator() = default;
  Integrator(const Integrator&) = delete;
  Integrator& operator=(const Integrator&) = delete;
  virtual ~Integrator() = default;

  /// Completes a state at time 0 from its displacement and its velocity at that time.
  virtual void start(MotionState& state) = 0;
  /// Takes the state one step further.
  virtual void advance(MotionState& state) = 0;
};

/// What an integrator works on; motion and loads must outlive it.
struct Integration {
  const DampedMotion& motion;
  const LoadHistory& load;
  double dt;
};

/// A registered integrator.
struct IntegratorEntry {
  EntryInfo info;
  /// Throws UsageError for values that do not fit, SkipCase for a damping it cannot take.
  std::unique_ptr<Integrator> (*make)(const Options& options, const Integration& integration);
  bool is_explicit;
};

/// All registered integrators, in the order of integrators.def. Each has the options `dt` and
/// `courant` beside its own.
const std::vector<IntegratorEntry>& integrators();

/// A `--time` spec, understood.
struct TimeSpec {
  std::string spec;               ///< canonical
  std::optional<double> dt;       ///< time step
  std::optional<double> courant;  ///< time step over the time q from node to node
  bool is_explicit = false;
};

/// Reads a `--time` spec. Throws UsageError when it is malformed or unknown, when a value does not
/// fit or when both `dt` and `courant` are given.
TimeSpec parse_time(std::string_view spec);

/// Makes the integrator of a spec. Throws as `IntegratorEntry::make` does.
std::unique_ptr<Integrator> make_integrator(std::string_view spec, const Integration& integration);

/// How the motion u'' = lambda u grows in one step of an integrator. Cost of a call: a few
/// microseconds. Copies and calls are safe from several threads.
class Amplification {
 public:
  /// Takes the spec of an integrator. Throws UsageError when it is malformed or unknown.
  explicit Amplification(std::string_view spec);

  /// Spectral radius of one step of the integrator itself, taken for each number that its state
  /// carries; 1 at most when it is stable, infinite when it overflows. Throws as
  /// `IntegratorEntry::make` does.
  double operator()(std::complex<double> lambda, const Damping& damping, double node_time,
                    double dt) const;

  /// The longest step up to which no motion u'' = -omega^2 u with omega^2 at most `spectral_radius`
  /// grows; infinite when steps of 1000 / omega do not. With y = omega dt: undamped, central
  /// differences hold up to y = 2 and rk4 up to 2 sqrt(2); damped by u'' = -omega^2 u - d u',
  /// central differences, which take the velocity half a step before, hold while y^2 + 2 d dt <= 4.
  /// At omega = 2 / q and dt = x q this is x^2 + 8 g x <= 1 with `hyper`, d = g q^3 omega^4, and
  /// x^2 + 2 eta x <= 1 with `stiffness`, d = eta q omega^2.
  double stable_step(double spectral_radius, const Damping& damping, double node_time) const;

 private:
  explicit Amplification(const Spec& spec);
  const IntegratorEntry& entry_;
  Options options_;
};

/// Growth per step, as `Amplification` gives it.
double amplification(std::string_view spec, std::complex<double> lambda, const Damping& damping,
                     double node_time, double dt);

/// The longest stable step, as `Amplification` gives it.
double stable_step(std::string_view spec, double spectral_radius, const Damping& damping,
                   double node_time);

}  // namespace strongpoint
