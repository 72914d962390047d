#pragma once

#include <utility>

#include <Eigen/LU>

#include "problems/core/motion.hpp"

namespace strongpoint {

/// u'' = K u + load f with a dense K.
class MatrixMotion final : public Motion {
 public:
  /// Takes K, (n, n), and f, (n).
  MatrixMotion(Eigen::MatrixXd matrix, Eigen::VectorXd load)
      : matrix_(std::move(matrix)), load_(std::move(load)) {}
  /// Nothing loads it.
  explicit MatrixMotion(const Eigen::MatrixXd& matrix)
      : MatrixMotion(matrix, Eigen::VectorXd::Zero(matrix.rows())) {}

  int size() const override { return static_cast<int>(matrix_.rows()); }
  void apply(const Eigen::VectorXd& u, Eigen::VectorXd& product) const override {
    product.noalias() = matrix_ * u;
  }
  const Eigen::VectorXd& load() const override { return load_; }
  std::unique_ptr<ShiftedMotion> shifted(double factor) const override {
    return std::make_unique<Factors>(Eigen::MatrixXd::Identity(size(), size()) - factor * matrix_);
  }
  /// K.
  const Eigen::MatrixXd& matrix() const { return matrix_; }

 private:
  class Factors final : public ShiftedMotion {
   public:
    explicit Factors(const Eigen::MatrixXd& matrix) : lu_(matrix) {}
    void solve(const Eigen::VectorXd& b, Eigen::VectorXd& x) const override { x = lu_.solve(b); }

   private:
    Eigen::PartialPivLU<Eigen::MatrixXd> lu_;
  };
  Eigen::MatrixXd matrix_;
  Eigen::VectorXd load_;
};

}  // namespace strongpoint
