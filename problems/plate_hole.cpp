#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "problems/core/domains/quarter_plate.hpp"
#include "problems/core/exact_elasticity.hpp"

namespace strongpoint {
namespace {

using Point2 = Point<2>;

using Map = QuarterPlate::Map;
using enum QuarterPlate::Side;

/// Displacements of an infinite plate with a hole under uniaxial tension along x, plane strain.
/// Source: Kirsch 1898, Muskhelishvili 1953, with kappa = 3 - 4 nu.
struct Kirsch {
  double a, kappa, mu, tension;

  template <class T>
  std::array<T, 2> operator()(const std::array<T, 2>& x) const {
    const T r = sqrt(x[0] * x[0] + x[1] * x[1]);
    const T c = x[0] / r;
    const T s = x[1] / r;
    const T c3 = c * (4.0 * c * c - 3.0);
    const T s3 = s * (3.0 - 4.0 * s * s);
    const T q = a / r;
    const double scale = tension * a / (8 * mu);
    return {
        scale * ((kappa + 1.0) * c / q + 2.0 * q * ((1.0 + kappa) * c + c3) - 2.0 * q * q * q * c3),
        scale *
            ((kappa - 3.0) * s / q + 2.0 * q * ((1.0 - kappa) * s + s3) - 2.0 * q * q * q * s3)};
  }
};

class PlateHole final : public ElasticProblem<2> {
 public:
  PlateHole(double a, double nu, Map map, double growth, Unknowns unknowns)
      : ElasticProblem(unknowns),
        domain_(a, map, growth),
        hole_radius_(a),
        material_(lame_constants(young, nu)),
        exact_(Kirsch{a, 3 - 4 * nu, material_.mu, tension}, material_) {}

  const Domain<2>& domain() const override { return domain_; }
  Lame material(const Place<2>&) const override { return material_; }
  std::vector<SymmetryPlane> symmetry_planes() const override {
    return {{left, 0, 0}, {bottom, 1, 0}};
  }
  Derivatives<2> measured_derivatives() const override { return first_derivatives(); }

  /// Symmetry on bottom and left; the exact tractions on right and top, where the hole is free
  /// because the exact solution is.
  Known known(int field, int side) const override {
    const int suppressed = side == bottom ? 1 : side == left ? 0 : -1;
    return field == suppressed ? Known::value : Known::flux;
  }
  double given(int field, int side, const Point2& x) const override {
    const bool is_loaded = side == right || side == top;
    return is_loaded ? exact_.stress_at(x).row(field).dot(domain_.normal(side, x)) : 0;
  }

  std::vector<std::string> quantities() const override {
    return {"sif_error", "displacement_error", "stress_xx_error", "stress_error"};
  }

  std::vector<double> measure(const Solution<2>& solution) const override {
    const Eigen::MatrixXd computed = nodal_stresses(solution);
    const Eigen::MatrixXd exact = exact_.stresses(solution.cloud);
    const double concentration = computed(0, notch_node(solution.cloud)) / tension;
    return {std::abs(3 - concentration) / 3, exact_.displacement_error(solution),
            relative_error(computed.row(0), exact.row(0)), relative_error(computed, exact)};
  }

 protected:
  std::optional<ElasticNodes> exact_at_nodes(const PointCloud<2>& cloud) const override {
    return exact_.at_nodes(cloud);
  }

 private:
  static constexpr double young = 1e5;    // thesis (4.16)
  static constexpr double tension = 100;  // thesis (4.16)
  QuarterPlate domain_;
  double hole_radius_;
  Lame material_;
  ExactElasticity<2, Kirsch> exact_;

  /// The node nearest to (0, a), where the stress is largest.
  int notch_node(const PointCloud<2>& cloud) const {
    Eigen::Index nearest = 0;
    (cloud.nodes.colwise() - Point2(0, hole_radius_)).colwise().squaredNorm().minCoeff(&nearest);
    return static_cast<int>(nearest);
  }
};

}  // namespace

/// Quarter of a plate with a circular hole under tension, exact tractions on the outer sides.
/// Source: thesis 4.2.1; the outer sides are x = 1 and y = 1 (not given there).
ProblemEntry problem_plate_hole() {
  return {{"plate_hole",
           "quarter plate with a hole under tension, plane strain, Kirsch's solution",
           {{"a", "0.2", "radius of the hole, 0.01 to 0.9"},
            {"nu", "0.33", "Poisson's ratio, 0 to 0.4999"},
            {"map", "log",
             "log | edge: spacing of a grid's nodes along a ray, isotropic at the hole or "
             "uniform"},
            {"growth", "1.5",
             "power of the distance from the hole's centre by which the spacing of scattered nodes "
             "grows, 0 to 2"},
            unknowns_option()}},
          [](const Options& options) -> AnyProblem {
            const double nu = options.number("nu", 0, 0.4999);
            return std::make_unique<PlateHole>(
                options.number("a", 0.01, 0.9), nu,
                options.choice<Map>("map", {{"log", Map::log}, {"edge", Map::edge}}),
                options.number("growth", 0, 2), chosen_unknowns(options, nu));
          }};
}

}  // namespace strongpoint
