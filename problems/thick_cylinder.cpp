#include "problems/core/domains/quarter_annulus.hpp"
#include "problems/core/thick_walled.hpp"

namespace strongpoint {

/// Quarter of a tube, radii 1 and 4, under pressure inside, plane strain. Source: Lame 1831.
ProblemEntry problem_thick_cylinder() {
  return {{"thick_cylinder",
           "quarter of a thick tube under pressure, plane strain, Lame's solution",
           {{"nu", "0.3", "Poisson's ratio, 0 to 0.49999"},
            {"radii", "geometric",
             "geometric | uniform: spacing of nodes along a radius, isotropic cells or constant"},
            unknowns_option()}},
          [](const Options& options) -> AnyProblem {
            using Region = QuarterAnnulus;
            const double nu = options.number("nu", 0, 0.49999);
            return std::make_unique<ThickWalled<2, Region>>(
                1, 4, nu, std::vector<SymmetryPlane>{{Region::left, 0, 0}, {Region::bottom, 1, 0}},
                chosen_unknowns(options, nu),
                options.choice<Radii>(
                    "radii", {{"geometric", Radii::geometric}, {"uniform", Radii::uniform}}));
          }};
}

}  // namespace strongpoint
