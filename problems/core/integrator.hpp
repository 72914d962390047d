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

/// Growth per step of the motion u'' = lambda u under an integrator and a damping: the spectral
/// radius of one step of the integrator itself, 1 at most when it is stable.
double amplification(std::string_view spec, std::complex<double> lambda, const Damping& damping,
                     double node_time, double dt);

/// The longest step up to which no motion u'' = -omega^2 u with omega^2 at most `spectral_radius`
/// grows; infinite when there is none.
double stable_step(std::string_view spec, double spectral_radius, const Damping& damping,
                   double node_time);

}  // namespace strongpoint
