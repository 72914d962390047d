#pragma once

#include <cstddef>

#include <Eigen/Core>

namespace strongpoint {

/// An approximate inverse of a matrix, applied in single precision: what it costs in accuracy is
/// far below its own error, and it halves the traffic.
class Preconditioner {
 public:
  explicit Preconditioner(Eigen::Index unknowns) : r_(unknowns), z_(unknowns) {}
  Preconditioner(const Preconditioner&) = delete;
  Preconditioner& operator=(const Preconditioner&) = delete;
  virtual ~Preconditioner() = default;

  /// z = approximately A^-1 r; r and z may not be the same.
  virtual void apply(const Eigen::VectorXf& r, Eigen::VectorXf& z) const = 0;
  /// Pivot blocks that were singular and have been shifted.
  virtual int shifted_pivots() const = 0;
  /// Memory that it holds.
  virtual std::size_t bytes() const = 0;

  /// The same for vectors of any magnitude. Not to be called from several threads.
  void apply(const Eigen::VectorXd& r, Eigen::VectorXd& z) const {
    const double size = r.lpNorm<Eigen::Infinity>();
    const double scale = size > 0 ? size : 1;
    r_ = (r / scale).cast<float>();
    apply(r_, z_);
    z = scale * z_.cast<double>();
  }

 private:
  mutable Eigen::VectorXf r_, z_;
};

}  // namespace strongpoint
