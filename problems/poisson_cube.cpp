#include "problems/core/manufactured_poisson.hpp"

namespace strongpoint {
namespace {

struct Exact {
  template <class T>
  T operator()(const std::array<T, 3>& x) const {
    return sin(2.0 * x[0] + 1.0) * cos(3.0 * x[1]) * sin(x[2] + 1.0);
  }
};

}  // namespace

/// Poisson's equation on [0,1]^3 with u = sin(2x+1) cos(3y) sin(z+1). Source: manufactured.
ProblemEntry problem_poisson_cube() {
  return manufactured_poisson<3, Exact>(
      "poisson_cube", "Poisson's equation on the unit cube, manufactured solution");
}

}  // namespace strongpoint
