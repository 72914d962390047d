#include "problems/core/growth.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace strongpoint {
namespace {

using Complex = std::complex<double>;

/// The factor a of u' in u'' = lambda u - a u'.
Complex friction(Complex lambda, const Damping& damping, double node_time) {
  switch (damping.kind) {
    case Damping::Kind::none:
      break;
    case Damping::Kind::stiffness:
      return -damping.strength * node_time * lambda;
    case Damping::Kind::hyper:
      return damping.strength * std::pow(node_time, 3) * lambda * lambda;
  }
  return 0;
}

/// Both roots of z^2 + p z + r, the smaller from the product, which does not cancel.
std::pair<Complex, Complex> roots(Complex p, Complex r) {
  const Complex root = std::sqrt(p * p - 4.0 * r);
  const Complex sum = (std::conj(p) * root).real() >= 0 ? p + root : p - root;
  if (sum == 0.0) return {0, 0};
  return {-sum / 2.0, -2.0 * r / sum};
}

double largest_modulus(const Eigen::VectorXcd& eigenvalues) {
  return eigenvalues.cwiseAbs().maxCoeff();
}

/// The strength with which lambda = -(x + i y) stops growing, infinite when there is none.
double strength_for(double x, double y, Damping::Kind kind, double node_time) {
  constexpr double none = std::numeric_limits<double>::infinity();
  if (kind == Damping::Kind::stiffness) {
    return x > 0 ? std::abs(y) / std::sqrt(x * (x * x + y * y)) / node_time : none;
  }
  if (x <= std::abs(y)) return none;
  return std::abs(y) / std::sqrt(x * (x - y) * (x + y) * (x * x + y * y)) / std::pow(node_time, 3);
}

}  // namespace

Growth fastest_growth(const Eigen::VectorXcd& eigenvalues, const Damping& damping,
                      double node_time) {
  Growth fastest{-std::numeric_limits<double>::infinity(), 0};
  for (const Complex& lambda : eigenvalues) {
    const auto [first, second] = roots(friction(lambda, damping, node_time), -lambda);
    const double rate = std::max(first.real(), second.real());
    if (rate > fastest.rate) fastest = {rate, lambda};
  }
  fastest.rate += 0.0;  // no -0 in tables
  return fastest;
}

std::optional<double> smallest_strength(const Eigen::VectorXcd& eigenvalues, Damping::Kind kind,
                                        double node_time) {
  constexpr double resolved = 1e-12;
  const double least = resolved * largest_modulus(eigenvalues);
  double largest = 0;
  for (const Complex& lambda : eigenvalues) {
    if (std::abs(lambda) <= least) continue;
    const double y = std::abs(lambda.imag()) <= least ? 0 : -lambda.imag();
    largest = std::max(largest, strength_for(-lambda.real(), y, kind, node_time));
  }
  if (std::isinf(largest)) return std::nullopt;
  return largest;
}

std::optional<double> strength_within(const Eigen::VectorXcd& eigenvalues, Damping::Kind kind,
                                      double node_time, double tolerance, double margin) {
  if (tolerance == 0) return smallest_strength(eigenvalues, kind, node_time);
  const auto is_calm = [&](double strength) {
    return fastest_growth(eigenvalues, {kind, strength}, node_time).rate <= tolerance;
  };
  if (is_calm(0)) return 0;
  constexpr double least = 1e-6;
  constexpr double most = 10;
  constexpr double ratio = 1.05;
  constexpr double precision = 1e-3;
  double first = 0;  // of the strengths since which all are calm
  double last_bad = least;
  const int steps = static_cast<int>(std::log(margin * most / least) / std::log(ratio));
  for (int i = 0; i <= steps; ++i) {
    const double strength = least * std::pow(ratio, i);
    if (!is_calm(strength)) {
      first = 0;
      last_bad = strength;
    } else if (first == 0) {
      first = strength;
      if (first > most) return std::nullopt;
    }
    if (first > 0 && strength >= margin * first) break;
  }
  if (first == 0) return std::nullopt;
  while (first > (1 + precision) * last_bad) {
    const double middle = std::sqrt(first * last_bad);
    (is_calm(middle) ? first : last_bad) = middle;
  }
  return first;
}

double growth_per_step(const Eigen::VectorXcd& eigenvalues, const Damping& damping,
                       double node_time, double dt) {
  double largest = 0;
  for (const Complex& lambda : eigenvalues) {
    const Complex b = dt * friction(lambda, damping, node_time);
    const auto [first, second] = roots(b - 2.0 - dt * dt * lambda, 1.0 - b);
    largest = std::max({largest, std::abs(first), std::abs(second)});
  }
  return largest;
}

double stable_step(const Eigen::VectorXcd& eigenvalues, const Damping& damping, double node_time,
                   double tolerance) {
  const double longest = 2 / std::sqrt(largest_modulus(eigenvalues));
  if (damping.kind == Damping::Kind::none || damping.strength == 0) return longest;
  constexpr double round_off = 1e-9;  // tells a root on the unit circle from one outside
  const auto is_stable = [&](double dt) {
    return growth_per_step(eigenvalues, damping, node_time, dt) <=
           std::exp(tolerance * dt) + round_off;
  };
  constexpr int samples = 400;  // steps may become stable again where damping oscillates
  double stable = 0;
  double unstable = longest;
  for (int i = 1; i <= samples; ++i) {
    unstable = longest * i / samples;
    if (!is_stable(unstable)) break;
    stable = unstable;
  }
  if (stable == 0 || stable == unstable) return stable;
  constexpr int bisections = 30;
  for (int i = 0; i < bisections; ++i) {
    const double middle = (stable + unstable) / 2;
    (is_stable(middle) ? stable : unstable) = middle;
  }
  return stable;
}

}  // namespace strongpoint
