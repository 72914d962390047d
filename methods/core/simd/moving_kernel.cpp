#include "methods/core/simd/moving_kernel.hpp"

#include "methods/core/simd/moving_group.hpp"

namespace strongpoint::STRONGPOINT_SIMD_PATH {

void fit_moving(const MovingTask& task) {
  switch (task.dim) {
    case 1:
      *task.done = MovingGroup<1>(task).run();
      return;
    case 2:
      *task.done = MovingGroup<2>(task).run();
      return;
    default:
      *task.done = MovingGroup<3>(task).run();
  }
}

}  // namespace strongpoint::STRONGPOINT_SIMD_PATH
