#include "problems/core/domains/shell_octant.hpp"
#include "problems/core/thick_walled.hpp"

namespace strongpoint {

/// Octant of a hollow sphere, radii 1 and 2, under pressure inside. Source: Lame 1852.
ProblemEntry problem_thick_sphere() {
  return {
      {"thick_sphere",
       "octant of a thick sphere under pressure, Lame's solution",
       {{"nu", "0.3", "Poisson's ratio, 0 to 0.49999"}, unknowns_option()}},
      [](const Options& options) -> AnyProblem {
        using Region = ShellOctant;
        const double nu = options.number("nu", 0, 0.49999);
        return std::make_unique<ThickWalled<3, Region>>(
            1, 2, nu,
            std::vector<SymmetryPlane>{{Region::x0, 0, 0}, {Region::y0, 1, 0}, {Region::z0, 2, 0}},
            chosen_unknowns(options, nu));
      }};
}

}  // namespace strongpoint
