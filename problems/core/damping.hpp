#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "methods/core/options.hpp"
#include "problems/core/motion.hpp"

namespace strongpoint {

/// How vibrations that the nodes do not resolve are damped; q is the time that a wave takes from
/// node to node. Source: Rayleigh's damping in proportion to stiffness; hyperviscosity as Fornberg
/// & Lehto 2011, with K for their Laplacian and the velocity for the field.
struct Damping {
  enum class Kind {
    none,       ///< u'' = K u
    stiffness,  ///< u'' = K (u + eta q u')
    hyper       ///< u'' = K (u - g q^3 K u')
  };
  Kind kind = Kind::none;
  double strength = 0;  ///< eta or g, dimensionless
};

/// Names, summaries and options of all dampings.
const std::vector<EntryInfo>& dampings();

/// Canonical form of a `--damping` spec. Throws UsageError when it is malformed or unknown, or when
/// a value does not fit.
std::string canonical_damping(std::string_view spec);

/// The damping of a spec. Throws UsageError as `canonical_damping` does.
Damping make_damping(std::string_view spec);

/// A motion with damping, which both must outlive.
class DampedMotion {
 public:
  /// Takes the time q.
  DampedMotion(const Motion& motion, const Damping& damping, double node_time);

  const Motion& motion() const { return motion_; }
  int size() const { return motion_.size(); }
  const Damping& damping() const { return damping_; }
  /// eta q, which multiplies K u'; 0 unless the damping is proportional to stiffness.
  double stiffness_time() const {
    return damping_.kind == Damping::Kind::stiffness ? damping_.strength * node_time_ : 0;
  }
  /// acceleration = K u + load f with damping for the velocity; (size) each. Products with K: one,
  /// two with `hyper`.
  void accelerate(const Eigen::VectorXd& u, const Eigen::VectorXd& velocity, double load,
                  Eigen::VectorXd& acceleration) const;

 private:
  const Motion& motion_;
  Damping damping_;
  double node_time_;
  mutable Eigen::VectorXd work_;
};

}  // namespace strongpoint
