#include "problems/core/manufactured_poisson.hpp"

namespace strongpoint {
namespace {

struct Exact {
  template <class T>
  T operator()(const std::array<T, 2>& x) const {
    return sin(2.0 * x[0] + 1.0) * cos(3.0 * x[1]);
  }
};

}  // namespace

/// Poisson's equation on [0,1]^2 with u = sin(2x+1) cos(3y). Source: manufactured.
ProblemEntry problem_poisson_square() {
  return manufactured_poisson<2, Exact>(
      "poisson_square", "Poisson's equation on the unit square, manufactured solution");
}

}  // namespace strongpoint
