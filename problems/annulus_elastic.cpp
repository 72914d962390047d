#include <cmath>
#include <numbers>

#include "problems/core/domains/quarter_annulus.hpp"
#include "problems/core/exact_elasticity.hpp"
#include "problems/core/transient_problem.hpp"

namespace strongpoint {
namespace {

using Point2 = Point<2>;

constexpr double inner_radius = 1;                  // thesis 4.5.2
constexpr double outer_radius = 4;                  // thesis 4.5.2
constexpr double young = 100;                       // not in the thesis, which states no material
constexpr double density = 100;                     // not in the thesis
constexpr double frequency = 2 * std::numbers::pi;  // thesis (4.45)

/// The motion at the height of its swing: u = v = xy (x^2 + y^2 - 16) (x^2 + y^2 - 1) / 100, zero
/// on the whole boundary. Source: thesis (4.45).
struct Swing {
  template <class T>
  std::array<T, 2> operator()(const std::array<T, 2>& x) const {
    const T square = x[0] * x[0] + x[1] * x[1];
    const T u = 0.01 * x[0] * x[1] * (square - outer_radius * outer_radius) *
                (square - inner_radius * inner_radius);
    return {u, u};
  }
};

/// Clamped all round, with the body force that the swing needs at its height.
class ClampedAnnulus final : public ElasticProblem<2> {
 public:
  explicit ClampedAnnulus(const Lame& material) : material_(material), exact_({}, material) {}

  const Domain<2>& domain() const override { return domain_; }
  Lame material(const Place<2>&) const override { return material_; }
  double inertia(int, const Place<2>&) const override { return density; }
  /// density u'' - div sigma, with u'' = -frequency^2 u.
  Point2 body_force(const Place<2>& place) const override {
    return exact_.body_force(place.x) - density * frequency * frequency * swing(place.x);
  }
  Known known(int, int) const override { return Known::value; }
  double given(int, int, const Point2&) const override { return 0; }
  std::vector<std::string> quantities() const override { return {}; }
  std::vector<double> measure(const Solution<2>&) const override { return {}; }

  Point2 swing(const Point2& x) const { return exact_.displacement(x); }

 private:
  QuarterAnnulus domain_{inner_radius, outer_radius, Radii::uniform};
  Lame material_;
  ExactElasticity<2, Swing> exact_;
};

class SwingingAnnulus final : public TransientProblem<2> {
 public:
  explicit SwingingAnnulus(double nu) : material_(lame_constants(young, nu)), space_(material_) {}

  const SteadyProblem<2>& space() const override { return space_; }
  double load(double time) const override { return std::sin(frequency * time); }
  double wave_speed() const override {
    return std::sqrt((material_.lambda + 2 * material_.mu) / density);
  }
  Eigen::VectorXd initial_velocity(const Point2& x) const override {
    return frequency * space_.swing(x);
  }
  double end_time() const override { return 1.75; }
  double time_step() const override { return 1e-3; }
  std::vector<std::string> quantities() const override { return {"u_error"}; }
  std::vector<double> measure(const Solution<2>& solution, double time) const override {
    double error = 0;
    double size = 0;
    for (int i = 0; i < solution.cloud.size(); ++i) {
      if (solution.cloud.is_boundary(i)) continue;
      const double swing = space_.swing(solution.cloud.nodes.col(i))[0];
      error += std::pow(solution.fields(0, i) - load(time) * swing, 2);
      size += std::pow(swing, 2);
    }
    return {std::sqrt(error / size)};
  }
  std::vector<NodeArray> derived_fields(const Solution<2>& solution, double time) const override {
    const std::vector<Lame> materials(static_cast<std::size_t>(solution.cloud.size()), material_);
    return elastic_arrays<2>(space_.fields(), materials, {solution.fields, {}},
                             ElasticNodes{exact_at(solution.cloud, time), {}});
  }

 private:
  Lame material_;
  ClampedAnnulus space_;

  Points<2> exact_at(const PointCloud<2>& cloud, double time) const {
    Points<2> exact(2, cloud.size());
    for (int i = 0; i < cloud.size(); ++i) {
      exact.col(i) = load(time) * space_.swing(cloud.nodes.col(i));
    }
    return exact;
  }
};

}  // namespace

/// A quarter of an annulus, radii 1 and 4, clamped all round, plane strain, E = 100, density 100,
/// swinging as u = v = xy (x^2 + y^2 - 16) (x^2 + y^2 - 1) sin(2 pi t) / 100 under the body force
/// that this takes. `u_error` is the 2-norm of the error of u over the nodes inside, relative to
/// that of u at the height of the swing, where it is judged. Source: thesis 4.5.2, (4.45), (4.46),
/// which states no material.
ProblemEntry problem_annulus_elastic() {
  return {{"annulus_elastic",
           "a clamped quarter of an annulus, plane strain, swinging under a body force",
           {{"nu", "0.3", "Poisson's ratio, 0 to 0.49999"}}},
          [](const Options& options) -> AnyProblem {
            return std::make_unique<SwingingAnnulus>(options.number("nu", 0, 0.49999));
          }};
}

}  // namespace strongpoint
