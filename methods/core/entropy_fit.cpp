#include "methods/core/entropy_fit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Cholesky>
#include <Eigen/Jacobi>

namespace strongpoint {
namespace {

/// Residual of the means at which Newton's method stops, D being of order one.
constexpr double mean_tolerance = 1e-13;
/// A residual that round-off may leave when no step lowers log Z any more.
constexpr double stagnation_tolerance = 1e-11;
/// Variances below this are round-off of those in other directions: p has gathered on a face.
constexpr double flat_variance = 1e-14;
/// Variances below this belong to directions off the face.
constexpr double null_variance = 1e-9;
/// Nodes this near to the span of a face belong to it.
constexpr double face_tolerance = 1e-9;
/// What may be left off a face, and how far its nodes' mean may be from the wanted one.
constexpr double mass_tolerance = 1e-6;
/// Each layer of nodes off a face takes about thirty steps to fade.
constexpr int most_steps = 200;
/// Steps that polish the means on a face, where Newton's method has all but converged.
constexpr int polishing_steps = 4;

/// Projector on the eigenvectors of a covariance whose variance is below `null_variance`, by
/// Jacobi's rotations.
template <int S>
Eigen::Matrix<double, S, S> null_projector(Eigen::Matrix<double, S, S> covariance) {
  constexpr int sweeps = 12;  // quadratic convergence: five are enough
  Eigen::Matrix<double, S, S> axes = Eigen::Matrix<double, S, S>::Identity();
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    for (int i = 0; i < S; ++i) {
      for (int j = i + 1; j < S; ++j) {
        Eigen::JacobiRotation<double> rotation;
        rotation.makeJacobi(covariance, i, j);
        covariance.applyOnTheLeft(i, j, rotation.adjoint());
        covariance.applyOnTheRight(i, j, rotation);
        axes.applyOnTheRight(i, j, rotation);
      }
    }
  }
  Eigen::Matrix<double, S, S> projector = Eigen::Matrix<double, S, S>::Zero();
  for (int i = 0; i < S; ++i) {
    if (covariance(i, i) < null_variance) projector += axes.col(i) * axes.col(i).transpose();
  }
  return projector;
}

}  // namespace

template <int S>
void EntropyFit<S>::resize(int n) {
  statistics_.resize(static_cast<std::size_t>(n) * S);
  log_prior_.resize(n);
  p_.resize(n);
}

template <int S>
double EntropyFit<S>::evaluate(const Vector& theta) {
  theta_ = theta;
  double largest = -std::numeric_limits<double>::infinity();
  for (int a = 0; a < size(); ++a) {
    p_[a] = log_prior_[a] + theta.dot(statistics(a));
    largest = std::max(largest, p_[a]);
  }
  double sum = 0;
  mean_.setZero();
  for (int a = 0; a < size(); ++a) {
    p_[a] = std::exp(p_[a] - largest);
    sum += p_[a];
    mean_ += p_[a] * statistics(a);
  }
  mean_ /= sum;
  covariance_.setZero();
  for (int a = 0; a < size(); ++a) {
    p_[a] /= sum;
    const Vector deviation = statistics(a) - mean_;
    covariance_.noalias() += (p_[a] * deviation) * deviation.transpose();
  }
  return largest + std::log(sum);
}

template <int S>
bool EntropyFit<S>::step(double& log_z) {
  constexpr double sufficient = 1e-4;  // of the fall that the slope predicts
  constexpr int most_halvings = 30;
  const Vector from = theta_;
  const Vector direction = -covariance_.ldlt().solve(mean_);
  const double slope = mean_.dot(direction);
  if (!(slope < 0)) return false;
  const double round_off = 4e-16 * (1 + std::abs(log_z));
  double length = 1;
  for (int i = 0; i < most_halvings; ++i, length /= 2) {
    const double trial = evaluate(from + length * direction);
    if (trial <= log_z + sufficient * length * slope + round_off) {
      log_z = trial;
      return true;
    }
  }
  evaluate(from);
  return false;
}

template <int S>
EntropyOutcome EntropyFit<S>::solve() {
  double log_z = evaluate(Vector::Zero());
  const double spread = covariance_.trace();
  bool is_flat = !(spread > 0);
  bool moves = true;
  for (int i = 0; i < most_steps && moves && !is_flat; ++i) {
    if (mean_.norm() <= mean_tolerance) break;
    moves = step(log_z);
    is_flat = !(covariance_.ldlt().vectorD().minCoeff() > flat_variance);
  }
  const Matrix off_face = null_projector<S>(covariance_);
  if (is_flat || off_face.trace() > 0.5) {
    const EntropyOutcome outcome = restrict_to_face(off_face);
    if (outcome == EntropyOutcome::on_face || is_flat) return outcome;
  }
  if (!(mean_.norm() <= stagnation_tolerance)) return EntropyOutcome::outside;
  inverse_ = covariance_.inverse();
  return inverse_.allFinite() ? EntropyOutcome::inside : EntropyOutcome::outside;
}

template <int S>
EntropyOutcome EntropyFit<S>::restrict_to_face(const Matrix& off_face) {
  const auto is_off = [&](int a) { return (off_face * statistics(a)).norm() > face_tolerance; };
  double mass = 0;
  for (int a = 0; a < size(); ++a) mass += is_off(a) ? 0 : p_[a];
  if (!(mass >= 1 - mass_tolerance)) return EntropyOutcome::outside;
  for (int a = 0; a < size(); ++a) {
    if (is_off(a)) log_prior_[a] = -std::numeric_limits<double>::infinity();
  }
  const Matrix onto = Matrix::Identity() - off_face;
  evaluate(onto * theta_);
  for (int i = 0; i < polishing_steps; ++i) {
    const Matrix regular = onto * covariance_ * onto + off_face;
    evaluate(theta_ - onto * regular.ldlt().solve(onto * mean_));
  }
  return mean_.norm() <= face_tolerance ? EntropyOutcome::on_face : EntropyOutcome::outside;
}

template <int S>
void EntropyFit<S>::add_first(double factor, const Vector& direction,
                              std::span<double> result) const {
  const Vector gradient = inverse_ * direction;
  for (int a = 0; a < size(); ++a) {
    result[a] += factor * p_[a] * gradient.dot(statistics(a) - mean_);
  }
}

template <int S>
void EntropyFit<S>::add_second(double factor, const Vector& a, const Vector& b, const Vector& ab,
                               std::span<double> result) const {
  const Vector gradient_a = inverse_ * a;
  const Vector gradient_b = inverse_ * b;
  Vector third = Vector::Zero();  // sum p (gradient_a . D) (gradient_b . D) D
  double second = 0;
  for (int i = 0; i < size(); ++i) {
    const Vector deviation = statistics(i) - mean_;
    const double product = p_[i] * gradient_a.dot(deviation) * gradient_b.dot(deviation);
    third += product * deviation;
    second += product;
  }
  const Vector gradient_ab = inverse_ * (ab - third);
  for (int i = 0; i < size(); ++i) {
    const Vector deviation = statistics(i) - mean_;
    result[i] += factor * p_[i] *
                 (gradient_a.dot(deviation) * gradient_b.dot(deviation) - second +
                  gradient_ab.dot(deviation));
  }
}

template class EntropyFit<1>;
template class EntropyFit<2>;
template class EntropyFit<3>;
template class EntropyFit<5>;

}  // namespace strongpoint
