#pragma once

#include <memory>
#include <vector>

#include <Eigen/Core>

#include "problems/core/solvers.hpp"

namespace strongpoint {

/// Solves with I - factor K for one factor, factorised once.
class ShiftedMotion {
 public:
  ShiftedMotion() = default;
  ShiftedMotion(const ShiftedMotion&) = delete;
  ShiftedMotion& operator=(const ShiftedMotion&) = delete;
  virtual ~ShiftedMotion() = default;

  /// x = (I - factor K)^-1 b, (size) each. Not to be called from several threads.
  virtual void solve(const Eigen::VectorXd& b, Eigen::VectorXd& x) const = 0;
};

/// Equations of motion u'' = K u + load(t) f in the unknowns that have inertia.
class Motion {
 public:
  Motion() = default;
  Motion(const Motion&) = delete;
  Motion& operator=(const Motion&) = delete;
  virtual ~Motion() = default;

  /// Number of unknowns that move.
  virtual int size() const = 0;
  /// product = K u, (size) each. Not to be called from several threads.
  virtual void apply(const Eigen::VectorXd& u, Eigen::VectorXd& product) const = 0;
  /// f, (size): the accelerations that data of size 1 cause.
  virtual const Eigen::VectorXd& load() const = 0;
  /// Factorises I - factor K; the motion must outlive the result. Throws CaseError when it is
  /// singular.
  virtual std::unique_ptr<ShiftedMotion> shifted(double factor) const = 0;
};

/// K as a matrix, (size, size); costs `size` products.
Eigen::MatrixXd dense_operator(const Motion& motion);

/// The motion of a discrete system in the nodal values that have inertia. Rows without inertia hold
/// at any time and are condensed: K = A_II - A_IB A_BB^-1 A_BI over the inertia, with the block
/// A_BB factorised once. Where unknowns are no nodal values, the rows V that give the values join
/// in: K u = [A_II, A_IB] x with [V; A_BI, A_BB] x = [u; 0], and each product solves with this
/// matrix. Boundary data then act on the values as they are, with no term in their second
/// derivative. Source: thesis (4.11) to (4.13), where K_IB K_BB^-1 ubar has the wrong sign on the
/// right.
class CondensedMotion final : public Motion {
 public:
  /// Takes the assembled system, the inertia of its rows as the equations state it, and the rows of
  /// the values of all unknowns, null where the unknowns are the values. Throws SkipCase for a
  /// system that is not square, CaseError when no row has inertia, and when rows without inertia do
  /// not determine the other unknowns.
  CondensedMotion(const LinearSystem& system, const std::vector<double>& inertia,
                  const LinearSystem* values);
  ~CondensedMotion() override;

  int size() const override { return static_cast<int>(moving_.size()); }
  void apply(const Eigen::VectorXd& u, Eigen::VectorXd& product) const override;
  const Eigen::VectorXd& load() const override { return load_; }
  std::unique_ptr<ShiftedMotion> shifted(double factor) const override;

  /// The unknowns of the system whose values move, ascending.
  const std::vector<int>& moving() const { return moving_; }
  /// All unknowns of the system when the moving values are u and the data are multiplied by `load`.
  /// Source: thesis (4.12).
  Eigen::VectorXd all_unknowns(const Eigen::VectorXd& u, double load) const;
  /// The moving ones of the nodal values of all unknowns of the system.
  Eigen::VectorXd from_values(const Eigen::VectorXd& values) const { return values(moving_); }

 private:
  struct Blocks;
  class Shifted;
  std::vector<int> moving_;
  std::unique_ptr<Blocks> blocks_;
  Eigen::VectorXd load_;
};

}  // namespace strongpoint
