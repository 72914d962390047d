#include "problems/core/elastic_bar.hpp"

namespace strongpoint {

/// Waves in a bar 1 x 0.2 x 0.2, E = 100, density 100, after a pulse of stress at its end. Source:
/// thesis 4.5.1 with a third dimension.
ProblemEntry problem_bar_3d() {
  return {{"bar_3d",
           "waves in a clamped bar of square section under a pulse of stress at its end",
           {{"nu", "0", "Poisson's ratio, 0 to 0.49999; the exact waves are known for 0"}}},
          [](const Options& options) -> AnyProblem {
            return std::make_unique<BarWaves<3>>(options.number("nu", 0, 0.49999));
          }};
}

}  // namespace strongpoint
