#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "problems/core/elasticity.hpp"
#include "problems/core/flux_problem.hpp"
#include "problems/core/jet.hpp"
#include "problems/core/norms.hpp"

namespace strongpoint {
namespace {

using Point2 = Point<2>;

enum class Map { log, edge };
enum Side { hole, bottom, right, top, left };

/// [0,1]^2 without the disc r < a. Unit coordinates are (angle over 90 degrees, position along the
/// ray).
class QuarterPlate final : public Domain<2> {
 public:
  QuarterPlate(double a, Map map) : a_(a), map_(map) {}

  const std::vector<std::string>& sides() const override {
    static const std::vector<std::string> names{"hole", "bottom", "right", "top", "left"};
    return names;
  }
  double measure() const override { return 1 - std::numbers::pi / 4 * a_ * a_; }
  double reference_length() const override { return 1; }

  Point2 map(const Point2& unit) const override {
    const Point2 ray = direction(unit[0]);
    if (map_ == Map::log) {
      const double outer = 1 / ray.maxCoeff();
      return a_ * std::pow(outer / a_, unit[1]) * ray;
    }
    const Point2 outer(std::min(1.0, 2 - 2 * unit[0]), std::min(1.0, 2 * unit[0]));
    return (1 - unit[1]) * a_ * ray + unit[1] * outer;
  }

  std::vector<int> sides_at(const Point2& unit) const override {
    std::vector<int> result;
    if (unit[1] == 0) result.push_back(hole);
    if (unit[0] == 0) result.push_back(bottom);
    if (unit[1] == 1 && unit[0] <= 0.5 + half_tolerance) result.push_back(right);
    if (unit[1] == 1 && unit[0] >= 0.5 - half_tolerance) result.push_back(top);
    if (unit[0] == 1) result.push_back(left);
    return result;
  }

  Point2 normal(int side, const Point2& x) const override {
    switch (side) {
      case hole:
        return -x.normalized();
      case bottom:
        return {0, -1};
      case right:
        return {1, 0};
      case top:
        return {0, 1};
      default:
        return {-1, 0};
    }
  }

  double distance(const Point2& x) const override {
    return std::max({a_ - x.norm(), x[0] - 1, x[1] - 1, -x[0], -x[1]});
  }

  std::vector<BoundaryPiece<2>> pieces() const override {
    using Parameter = BoundaryPiece<2>::Parameter;
    const double a = a_;
    return {{hole, [a](const Parameter& t) -> Point2 { return a * direction(t[0]); }},
            {bottom, [a](const Parameter& t) { return Point2(a + (1 - a) * t[0], 0); }},
            {right, [](const Parameter& t) { return Point2(1, t[0]); }},
            {top, [](const Parameter& t) { return Point2(t[0], 1); }},
            {left, [a](const Parameter& t) { return Point2(0, a + (1 - a) * t[0]); }}};
  }

  /// c a (r/a)^1.5 with c = (pi/2) / (n-1): n nodes on the arc.
  double spacing(const Point2& x, int level) const override {
    return std::numbers::pi / 2 / (level - 1) * a_ * std::pow(std::max(x.norm(), a_) / a_, 1.5);
  }

 private:
  static constexpr double half_tolerance = 1e-12;  // round-off of i / (n-1)
  double a_;
  Map map_;

  /// Unit vector at t * 90 degrees, exact at both ends.
  static Point2 direction(double t) {
    if (t == 0) return {1, 0};
    if (t == 1) return {0, 1};
    const double angle = t * std::numbers::pi / 2;
    return {std::cos(angle), std::sin(angle)};
  }
};

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

class PlateHole final : public FluxProblem<2> {
 public:
  PlateHole(double a, double nu, Map map)
      : domain_(a, map),
        hole_radius_(a),
        material_(lame_constants(young, nu)),
        exact_{a, 3 - 4 * nu, material_.mu, tension} {}

  const Domain<2>& domain() const override { return domain_; }
  std::vector<std::string> fields() const override { return {"u", "v"}; }
  Derivatives<2> derivatives(std::span<const BoundaryMark<2>> marks) const override {
    return marks.empty() ? Derivatives<2>{{2, 0}, {1, 1}, {0, 2}} : first_derivatives;
  }
  Derivatives<2> measured_derivatives() const override { return first_derivatives; }

  void equations(const Node<2>& node, EquationWriter<2>& write) const override {
    if (node.marks.empty()) {
      for (int i = 0; i < 2; ++i) {
        add_equilibrium(write, material_, i);
        write.equals(0);
      }
    } else if (const int plane = symmetry_plane(node); plane >= 0) {
      write_symmetry(node, plane, write);
    } else if (node.marks.size() > 1) {
      // Two loaded sides meet: the normal stress of each.
      for (const BoundaryMark<2>& mark : node.marks)
        write_traction(node, mark.normal, mark.normal, write);
    } else {
      for (int i = 0; i < 2; ++i)
        write_traction(node, Point2::Unit(i), node.marks[0].normal, write);
    }
  }

  void flux(int field, const Point2& direction, EquationWriter<2>& write) const override {
    add_traction<2>(write, material_, Point2::Unit(field), direction);
  }
  double source(int, const Point2&) const override { return 0; }
  SideCondition condition(int field, int side, const Point2& x) const override {
    if (field == suppressed(side)) return {SideCondition::Kind::value, 0};
    const bool is_loaded = side == right || side == top;
    const Point2 n = domain_.normal(side, x);
    return {SideCondition::Kind::flux, is_loaded ? exact_stress_at(x).row(field).dot(n) : 0};
  }

  std::vector<std::string> quantities() const override {
    return {"sif_error", "displacement_error", "stress_xx_error", "stress_error"};
  }

  std::vector<double> measure(const Solution<2>& solution) const override {
    const int count = solution.cloud.size();
    Eigen::MatrixXd displacement(2, count);
    Eigen::MatrixXd exact_stress(3, count);
    Eigen::MatrixXd computed_stress(3, count);
    std::array<Eigen::VectorXd, 4> slopes;  // u_x, u_y, v_x, v_y
    for (int d = 0; d < 4; ++d) slopes[d] = solution.derivative(d / 2, first_derivatives[d % 2]);
    for (int i = 0; i < count; ++i) {
      const Point2 x = solution.cloud.nodes.col(i);
      const auto jets = jets_at<2, 1>(exact_, x);
      displacement.col(i) << jets[0].value(), jets[1].value();
      Eigen::Matrix2d gradient;
      gradient << slopes[0][i], slopes[1][i], slopes[2][i], slopes[3][i];
      computed_stress.col(i) = components(stress<2>(material_, gradient));
      exact_stress.col(i) = components(exact_stress_at(x));
    }
    const double concentration = computed_stress(0, notch_node(solution.cloud)) / tension;
    return {std::abs(3 - concentration) / 3, relative_error(solution.fields, displacement),
            relative_error(computed_stress.row(0), exact_stress.row(0)),
            relative_error(computed_stress, exact_stress)};
  }

 private:
  static constexpr double young = 1e5;    // thesis (4.16)
  static constexpr double tension = 100;  // thesis (4.16)
  inline static const Derivatives<2> first_derivatives{{1, 0}, {0, 1}};
  QuarterPlate domain_;
  double hole_radius_;
  Lame material_;
  Kirsch exact_;

  static Eigen::Vector3d components(const Eigen::Matrix2d& sigma) {
    return {sigma(0, 0), sigma(1, 1), sigma(0, 1)};
  }

  Eigen::Matrix2d exact_stress_at(const Point2& x) const {
    const auto jets = jets_at<2, 1>(exact_, x);
    Eigen::Matrix2d gradient;
    for (int i = 0; i < 2; ++i) {
      for (int j = 0; j < 2; ++j) gradient(i, j) = jets[i].derivative(partial<2>(j));
    }
    return stress<2>(material_, gradient);
  }

  /// The displacement component that a side suppresses, being a symmetry plane, -1 when it is none.
  static int suppressed(int side) { return side == bottom ? 1 : side == left ? 0 : -1; }

  /// The same for the first symmetry plane at a node.
  static int symmetry_plane(const Node<2>& node) {
    for (const BoundaryMark<2>& mark : node.marks) {
      if (suppressed(mark.side) >= 0) return suppressed(mark.side);
    }
    return -1;
  }

  /// Zero normal displacement; zero shear, or, where a loaded or free side meets the plane, that
  /// side's traction along the plane.
  void write_symmetry(const Node<2>& node, int plane, EquationWriter<2>& write) const {
    write.add(plane, {0, 0}, 1);
    write.equals(0);
    const Point2 along = Point2::Unit(1 - plane);
    for (const BoundaryMark<2>& mark : node.marks) {
      if (suppressed(mark.side) < 0) return write_traction(node, along, mark.normal, write);
    }
    add_traction<2>(write, material_, along, Point2::Unit(plane));
    write.equals(0);
  }

  /// The component along m of the traction on a face with normal n equals the exact one; the hole
  /// is free because the exact solution is.
  void write_traction(const Node<2>& node, const Point2& m, const Point2& n,
                      EquationWriter<2>& write) const {
    add_traction<2>(write, material_, m, n);
    write.equals(node.on(hole) ? 0 : m.dot(exact_stress_at(node.x) * n));
  }

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
             "uniform"}}},
          [](const Options& options) -> AnyProblem {
            return std::make_unique<PlateHole>(
                options.number("a", 0.01, 0.9), options.number("nu", 0, 0.4999),
                options.choice<Map>("map", {{"log", Map::log}, {"edge", Map::edge}}));
          }};
}

}  // namespace strongpoint
