#pragma once

#include <complex>
#include <optional>

#include <Eigen/Core>

#include "problems/core/damping.hpp"

namespace strongpoint {

// Dampings leave the eigenvectors of K alone, so that all there is to know of growth follows from
// its eigenvalues: each lambda moves by itself, u'' = lambda u - a u' with a = g q^3 lambda^2
// (hyper) or a = -eta q lambda (stiffness), q being the time of a wave from node to node.

/// A vibration of a spectrum and how it grows.
struct Growth {
  double rate;                  ///< max Re s over all vibrations exp(s t), 1 over time
  std::complex<double> lambda;  ///< eigenvalue of K that grows at that rate
};

/// The fastest growth with a damping, from the eigenvalues of K: the roots of s^2 + a s - lambda.
Growth fastest_growth(const Eigen::VectorXcd& eigenvalues, const Damping& damping,
                      double node_time);

/// The smallest strength of a kind of damping (not `none`) with which no vibration grows; any
/// larger one does as well, and there may be none. With lambda = -(x + i y), the criterion of Routh
/// and Hurwitz for polynomials with complex coefficients gives, for each eigenvalue, g^2 q^6 x (x^4
/// - y^4) >= y^2 with x > |y|, and eta^2 q^2 x (x^2 + y^2) >= y^2 with x > 0: what lies more than
/// 45 degrees off the negative axis is beyond hyperviscosity. Imaginary parts below 1e-12 of the
/// largest eigenvalue, which dense algebra does not resolve, count as none, and so do eigenvalues.
std::optional<double> smallest_strength(const Eigen::VectorXcd& eigenvalues, Damping::Kind kind,
                                        double node_time);

/// The smallest strength, 10 at most, with which no vibration grows faster than `tolerance` (1 over
/// time), nor with those up to `margin` times as strong: growth that is left over need not fall all
/// the way. None when there is no such strength; 0 when nothing has to be damped. Found by steps of
/// 5 % from 1e-6 on and bisection to 0.1 %; without a tolerance it is `smallest_strength`.
std::optional<double> strength_within(const Eigen::VectorXcd& eigenvalues, Damping::Kind kind,
                                      double node_time, double tolerance, double margin);

/// Growth per step of central differences, the largest |z| of z^2 - (2 - b + lambda dt^2) z + 1 - b
/// with b = a dt, over all eigenvalues: the velocity that is damped lies half a step back.
double growth_per_step(const Eigen::VectorXcd& eigenvalues, const Damping& damping,
                       double node_time, double dt);

/// The longest step of central differences up to which no vibration grows faster than `tolerance`
/// (1 over time), or by more than 1e-9 a step. Without damping, where complex eigenvalues grow with
/// any step, as they do without one, it is that of oscillations as fast as the fastest, 2 /
/// sqrt(max |lambda|). Zero when damping is so weak or so strong that even 1/400 of that is too
/// long.
double stable_step(const Eigen::VectorXcd& eigenvalues, const Damping& damping, double node_time,
                   double tolerance = 0);

}  // namespace strongpoint
