#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>
#include <Eigen/LU>

namespace strongpoint {

/// Where the wanted means lie among the statistics of the nodes.
enum class EntropyOutcome : std::uint8_t {
  inside,   ///< inside their convex hull: the distribution is positive everywhere
  on_face,  ///< on its boundary: the distribution lives on one face
  outside   ///< nowhere: no distribution has these means
};

/// The distribution p_a = w_a exp(theta . D_a) / Z of largest entropy relative to a prior w among
/// those for which the mean of the statistics D_a (S of them, less their wanted means) vanishes,
/// and its derivatives as the wanted means m move: an exponential family in its mean parameters.
/// Source: Arroyo & Ortiz 2006, Cyron, Arroyo & Ortiz 2009; thesis (1.44)-(1.46), (1.53)-(1.58)
/// with log Z in place of Z in (1.56), (1.58). What does not depend on the node cancels in Z, so
/// that only D and the prior enter. The minimum of log Z is found by Newton's method with halved
/// steps.
template <int S>
class EntropyFit {
 public:
  using Vector = Eigen::Matrix<double, S, 1>;
  using Matrix = Eigen::Matrix<double, S, S>;

  /// Makes room for n nodes, whose statistics and priors are then to be filled in.
  void resize(int n);
  int size() const { return static_cast<int>(p_.size()); }
  /// The statistics of a node less their wanted means, D_a.
  Eigen::Map<Vector> statistics(int node) {
    return Eigen::Map<Vector>(statistics_.data() + static_cast<std::ptrdiff_t>(node) * S);
  }
  /// log w_a.
  double& log_prior(int node) { return log_prior_[node]; }
  /// Finds theta; D should be of order one. Everything below asks for `inside` or `on_face`.
  EntropyOutcome solve();
  /// The distribution p; zero, not merely small, off the face.
  std::span<const double> distribution() const { return p_; }
  /// Sum of the inverse variances along the principal axes: large where p is nearly on a face and
  /// its derivatives are wild; asks for `inside`, as the next two do.
  double strain() const { return inverse_.trace(); }
  /// Adds factor times dp_a / dm along `direction`.
  void add_first(double factor, const Vector& direction, std::span<double> result) const;
  /// Adds factor times the second derivative of p_a along a path of means that has the rates `a`
  /// and `b` in two parameters, and the mixed rate `ab`.
  void add_second(double factor, const Vector& a, const Vector& b, const Vector& ab,
                  std::span<double> result) const;

 private:
  std::vector<double> statistics_, log_prior_, p_;
  Vector theta_, mean_;
  Matrix covariance_, inverse_;

  Eigen::Map<const Vector> statistics(int node) const {
    return Eigen::Map<const Vector>(statistics_.data() + static_cast<std::ptrdiff_t>(node) * S);
  }
  /// Fills p, its mean and covariance at theta; returns log Z.
  double evaluate(const Vector& theta);
  /// One damped Newton step; false when log Z does not fall any more.
  bool step(double& log_z);
  /// Keeps the nodes of the face on which p has gathered, if that face holds the wanted means;
  /// `off_face` projects on its normals.
  EntropyOutcome restrict_to_face(const Matrix& off_face);
};

extern template class EntropyFit<1>;
extern template class EntropyFit<2>;
extern template class EntropyFit<3>;
extern template class EntropyFit<5>;

}  // namespace strongpoint
