#include "methods/core/simd/weight_kernel.hpp"

#include "methods/core/simd/lane_formula.hpp"

namespace strongpoint::STRONGPOINT_SIMD_PATH {

void weigh_distances(const WeightTask& task) {
  const LaneFormula formula(*task.formula);
  const auto weigh = [&](const double* rho, double* squared) {
    const Pack distance = load(rho);
    store(squared, formula.at_square(distance * distance));
  };
  const long whole = task.count / lanes * lanes;
  for (long i = 0; i < whole; i += lanes) weigh(task.rho + i, task.squared + i);
  if (whole == task.count) return;
  double rho[lanes];
  double squared[lanes];
  for (int lane = 0; lane < lanes; ++lane) {
    rho[lane] = whole + lane < task.count ? task.rho[whole + lane] : 1;
  }
  weigh(rho, squared);
  for (long i = whole; i < task.count; ++i) task.squared[i] = squared[i - whole];
}

}  // namespace strongpoint::STRONGPOINT_SIMD_PATH
