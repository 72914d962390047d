#include "methods/core/simd/taylor_kernel.hpp"

#include "methods/core/simd/taylor_group.hpp"

namespace strongpoint::STRONGPOINT_SIMD_PATH {
namespace {

template <int Dim, int Order>
void fit(const TaylorTask& task) {
  Piece waiting;
  for (int first = 0; first < task.stencils.table.count; first += lanes) {
    task.done[first / lanes] = TaylorGroup<Dim, Order>(task, first, waiting).run();
  }
  waiting.write();
  end_streams();
}

template <int Dim>
void fit_any_order(const TaylorTask& task) {
  switch (task.stencils.order) {
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
  switch (task.stencils.dim) {
    case 1:
      return fit_any_order<1>(task);
    case 2:
      return fit_any_order<2>(task);
    default:
      return fit_any_order<3>(task);
  }
}

}  // namespace strongpoint::STRONGPOINT_SIMD_PATH
