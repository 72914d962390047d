#include "methods/core/simd/gather_kernel.hpp"

#include "methods/core/simd/lane_gather.hpp"

namespace strongpoint::STRONGPOINT_SIMD_PATH {
namespace {

template <int Dim>
void gather(const GatherTask& task) {
  const long size = task.table.size;
  for (int first = 0, group = 0; first < task.table.count; first += lanes, ++group) {
    LaneStencils stencils;
    // Arrays for kernels begin at cache lines.
    stencils.z = reinterpret_cast<Pack*>(task.z) + group * size * Dim;
    stencils.rho = reinterpret_cast<Pack*>(task.rho) + group * size;
    gather_lanes<Dim>(task.table, first, stencils);
    store(task.radius + group * lanes, stencils.radius);
    task.faulty[group] = stencils.coincident;
  }
}

}  // namespace

void gather_stencils(const GatherTask& task) {
  switch (task.dim) {
    case 1:
      return gather<1>(task);
    case 2:
      return gather<2>(task);
    default:
      return gather<3>(task);
  }
}

}  // namespace strongpoint::STRONGPOINT_SIMD_PATH
