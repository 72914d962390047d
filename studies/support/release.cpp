#include "studies/support/release.hpp"

#include <vector>

#include "methods/core/kept_memory.hpp"

namespace strongpoint {

Weights weights_of(const Weights& weights, std::span<const int> slots) {
  Weights some;
  some.per_entry = static_cast<int>(slots.size());
  some.offsets = weights.offsets;
  some.columns = weights.columns;
  some.values.resize(weights.columns.size() * slots.size());
#pragma omp parallel for schedule(static)
  for (int point = 0; point < weights.size(); ++point) {
    double* to = some.values.data() + weights.offsets[point] * some.per_entry;
    const double* from = weights.values.data() + weights.offsets[point] * weights.per_entry;
    for (std::size_t j = 0; j < weights.nodes(point).size(); ++j, from += weights.per_entry) {
      for (const int slot : slots) *to++ = from[slot];
    }
  }
  return some;
}

template <int Dim>
void release_unread(const SteadyProblem<Dim>& problem, Discretisation<Dim>& scene,
                    std::size_t least_bytes) {
  Derivatives<Dim> read = problem.measured_derivatives();
  read.merge({MultiIndex<Dim>{}});  // where unknowns are no values
  Derivatives<Dim> left;
  std::vector<int> slots;
  for (int d = 0; d < scene.derivatives.size(); ++d) {
    if (!read.contains(scene.derivatives[d])) continue;
    left.merge({scene.derivatives[d]});
    slots.push_back(d);
  }
  const std::size_t unread = scene.derivatives.size() - slots.size();
  if (scene.weights.columns.size() * unread * sizeof(double) < least_bytes) return;
  scene.stencils = {};
  scene.weights = weights_of(scene.weights, slots);
  scene.derivatives = left;
  release_kept_memory();
}

template void release_unread(const SteadyProblem<1>&, Discretisation<1>&, std::size_t);
template void release_unread(const SteadyProblem<2>&, Discretisation<2>&, std::size_t);
template void release_unread(const SteadyProblem<3>&, Discretisation<3>&, std::size_t);

}  // namespace strongpoint
