#include "problems/core/gauss_legendre.hpp"

#include <cmath>
#include <numbers>

namespace strongpoint {
namespace {

/// Values of the Legendre polynomials of degrees n and n - 1, and the slope of the first, at x
/// within (-1, 1).
struct Legendre {
  double value, before, slope;

  Legendre(int n, double x) {
    before = 1;
    value = x;
    for (int k = 2; k <= n; ++k) {
      const double next = ((2 * k - 1) * x * value - (k - 1) * before) / k;
      before = value;
      value = next;
    }
    slope = n * (x * value - before) / (x * x - 1);
  }
};

}  // namespace

LineRule gauss_legendre(int n) {
  LineRule rule;
  for (int i = n - 1; i >= 0; --i) {
    double x = std::cos(std::numbers::pi * (i + 0.75) / (n + 0.5));  // Tricomi's estimate
    for (int step = 0; step < 8; ++step) {
      const Legendre p(n, x);
      x -= p.value / p.slope;
    }
    const double slope = Legendre(n, x).slope;
    rule.at.push_back((1 + x) / 2);
    rule.weight.push_back(1 / ((1 - x * x) * slope * slope));
  }
  return rule;
}

LineRule gauss_lobatto(int n) {
  const int degree = n - 1;
  const double ends = 1.0 / (degree * n);
  LineRule rule{{0.0}, {ends}};
  for (int i = degree - 1; i > 0; --i) {
    double x = std::cos(std::numbers::pi * i / degree);  // Chebyshev-Lobatto
    for (int step = 0; step < 12; ++step) {
      const Legendre p(degree, x);
      x -= (x * p.value - p.before) / (n * p.value);
    }
    const double value = Legendre(degree, x).value;
    rule.at.push_back((1 + x) / 2);
    rule.weight.push_back(ends / (value * value));
  }
  rule.at.push_back(1);
  rule.weight.push_back(ends);
  return rule;
}

}  // namespace strongpoint
