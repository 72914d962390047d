#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "problems/core/domains/polygon.hpp"
#include "problems/core/elastic_problem.hpp"
#include "problems/core/probes.hpp"

namespace strongpoint {
namespace {

using Point2 = Point<2>;

enum Side { bottom, right, top, clamped };

/// Converged vertical displacements at (48,60) and (48,52): p-version finite elements graded to the
/// singular corners, digits as known.
struct Reference {
  double nu, corner, middle;
};
constexpr Reference references[] = {
    {0.33, 22.6578, 21.5692}, {0.49, 19.6651, 18.7367}, {0.499, 19.450, 18.533}};

std::optional<Reference> reference_for(double nu) {
  for (const Reference& reference : references) {
    if (std::abs(nu - reference.nu) < 1e-12) return reference;
  }
  return {};
}

class Cook final : public ElasticProblem<2> {
 public:
  Cook(double nu, double grade, Unknowns unknowns)
      : ElasticProblem(unknowns),
        domain_({{0, 0}, {length, 44}, {length, 60}, {0, 44}},
                {"bottom", "right", "top", "clamped"}, length, {grade, reach}),
        material_(lame_constants(young, nu)),
        reference_(reference_for(nu)) {}

  const Domain<2>& domain() const override { return domain_; }
  Lame material(const Place<2>&) const override { return material_; }
  Known known(int, int side) const override { return side == clamped ? Known::value : Known::flux; }
  double given(int field, int side, const Point2&) const override {
    return side == right && field == 1 ? shear : 0;
  }
  /// Stresses are what one looks at here, at the clamped nodes too.
  Derivatives<2> measured_derivatives() const override { return first_derivatives(); }
  bool owns_corners(int side) const override { return side == right; }

  std::vector<std::string> quantities() const override {
    if (!reference_) return {"v_corner", "v_mid"};
    return {"v_corner", "v_mid", "v_corner_error", "v_mid_error"};
  }
  std::vector<double> measure(const Solution<2>& solution) const override {
    const double corner = solution.fields(1, node_at<2>(solution.cloud, {length, 60}));
    const double middle = middle_displacement(solution);
    if (!reference_) return {corner, middle};
    return {corner, middle, std::abs(corner / reference_->corner - 1),
            std::abs(middle / reference_->middle - 1)};
  }

 private:
  static constexpr double length = 48;
  static constexpr double reach = 20;        // of the graded spacing
  static constexpr double young = 1;         // thesis 4.2.2
  static constexpr double shear = 1.0 / 16;  // thesis 4.2.2: a unit force on the side of 16
  Polygon domain_;
  Lame material_;
  std::optional<Reference> reference_;

  /// v at (48, 52), linear between the nodes of the right side next to it.
  static double middle_displacement(const Solution<2>& solution) {
    constexpr double height = 52;
    int below = -1, above = -1;
    const auto y = [&](int node) { return solution.cloud.nodes(1, node); };
    for (int i = 0; i < solution.cloud.size(); ++i) {
      if (!node_of(solution.cloud, i).on(right)) continue;
      if (y(i) <= height && (below < 0 || y(i) > y(below))) below = i;
      if (y(i) >= height && (above < 0 || y(i) < y(above))) above = i;
    }
    if (below < 0 || above < 0) {
      throw CaseError(
          "the solution is judged at (48, 52), but the side right has no node on one side of it; "
          "add nodes at its ends");
    }
    const double v_below = solution.fields(1, below);
    if (below == above) return v_below;
    const double part = (height - y(below)) / (y(above) - y(below));
    return v_below + part * (solution.fields(1, above) - v_below);
  }
};

}  // namespace

/// Cook's membrane, clamped on the left, sheared on the right, plane strain. The loaded side gives
/// both tractions at its corners. `v_corner` is the vertical displacement at (48,60), `v_mid` that
/// at (48,52), in units of length; their relative errors are given for nu = 0.33, 0.49 and 0.499,
/// where converged values are known. Source: Cook 1974; thesis 4.2.2.
ProblemEntry problem_cook() {
  return {{"cook",
           "Cook's membrane, clamped and sheared, plane strain; singular at its corners",
           {{"nu", "0.33", "Poisson's ratio, 0 to 0.49999"},
            {"grade", "1",
             "spacing of scattered nodes at the corners over that at a distance of 20, 0.001 to 1"},
            unknowns_option()}},
          [](const Options& options) -> AnyProblem {
            const double nu = options.number("nu", 0, 0.49999);
            return std::make_unique<Cook>(nu, options.number("grade", 1e-3, 1),
                                          chosen_unknowns(options, nu));
          }};
}

}  // namespace strongpoint
