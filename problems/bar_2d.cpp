#include "problems/core/elastic_bar.hpp"

namespace strongpoint {

/// Waves in a plane bar 1 x 0.2, plane strain, E = 100, density 100, after a pulse of stress at its
/// end. Source: thesis 4.5.1, (4.41) to (4.44).
ProblemEntry problem_bar_2d() {
  return {{"bar_2d",
           "waves in a clamped plane bar under a pulse of stress at its end",
           {{"nu", "0", "Poisson's ratio, 0 to 0.49999; the exact waves are known for 0"}}},
          [](const Options& options) -> AnyProblem {
            return std::make_unique<BarWaves<2>>(options.number("nu", 0, 0.49999));
          }};
}

}  // namespace strongpoint
