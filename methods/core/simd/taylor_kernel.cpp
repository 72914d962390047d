#include "methods/core/simd/taylor_kernel.hpp"

#include "methods/core/simd/lane_gather.hpp"
#include "methods/core/simd/taylor_group.hpp"

namespace strongpoint::STRONGPOINT_SIMD_PATH {
namespace {

/// Gathers one group, which is fitted while it is near.
template <int Dim>
void gather_group(const GatherTask& task, int first) {
  LaneStencils stencils;
  stencils.z = reinterpret_cast<Pack*>(task.z);
  stencils.rho = reinterpret_cast<Pack*>(task.rho);
  gather_squares<Dim>(task.table, first, stencils);
  store(task.radius + first, stencils.radius);
  task.faulty[first / lanes] = stencils.coincident;
}

template <int Dim, int Order>
void fit(const TaylorTask& task) {
  Piece waiting;
  for (int first = 0; first < task.gathered.table.count; first += lanes) {
    if (task.squared == nullptr) gather_group<Dim>(task.gathered, first);
    task.done[first / lanes] = TaylorGroup<Dim, Order>(task, first, waiting).run();
  }
  waiting.write();
  end_streams();
}

template <int Dim>
void fit_any_order(const TaylorTask& task) {
  switch (task.order) {
    case 1:
      return fit<Dim, 1>(task);
    case 2:
      return fit<Dim, 2>(task);
    case 3:
      return fit<Dim, 3>(task);
    default:
      if constexpr (Dim < 3) fit<Dim, 4>(task);
  }
}

}  // namespace

void fit_taylor(const TaylorTask& task) {
  switch (task.gathered.dim) {
    case 1:
      return fit_any_order<1>(task);
    case 2:
      return fit_any_order<2>(task);
    default:
      return fit_any_order<3>(task);
  }
}

}  // namespace strongpoint::STRONGPOINT_SIMD_PATH
