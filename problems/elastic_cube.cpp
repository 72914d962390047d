#include <numbers>

#include "problems/core/exact_elasticity.hpp"

namespace strongpoint {
namespace {

/// Faces with given tractions; displacements are given on the others.
enum class Traction {
  one,   ///< x = 1
  three  ///< x = 1, y = 1 and z = 1
};

/// u_i = sin(pi x / 2 + i) cos(pi y / 3) sin(pi z / 4 + 1), i = 0, 1, 2.
struct Waves {
  template <class T>
  std::array<T, 3> operator()(const std::array<T, 3>& x) const {
    using std::cos, std::sin;
    constexpr double pi = std::numbers::pi;
    const T common = cos(pi / 3 * x[1]) * sin(pi / 4 * x[2] + 1.0);
    const T angle = pi / 2 * x[0];
    return {sin(angle) * common, sin(angle + 1.0) * common, sin(angle + 2.0) * common};
  }
};

class ElasticCube final : public ElasticProblem<3> {
 public:
  ElasticCube(double nu, Traction traction)
      : traction_(traction), material_(lame_constants(young, nu)), exact_(Waves{}, material_) {}

  const Domain<3>& domain() const override { return domain_; }
  Lame material(const Place<3>&) const override { return material_; }
  Point<3> body_force(const Place<3>& place) const override { return exact_.body_force(place.x); }
  Derivatives<3> measured_derivatives() const override { return first_derivatives(); }
  Known known(int, int side) const override { return is_loaded(side) ? Known::flux : Known::value; }
  double given(int field, int side, const Point<3>& x) const override {
    if (!is_loaded(side)) return exact_.displacement(x)[field];
    return exact_.stress_at(x).row(field).dot(domain_.normal(side, x));
  }

  std::vector<std::string> quantities() const override {
    return {"displacement_error", "stress_error"};
  }
  std::vector<double> measure(const Solution<3>& solution) const override {
    return errors_at_nodes(solution);
  }

 protected:
  std::optional<ElasticNodes> exact_at_nodes(const PointCloud<3>& cloud) const override {
    return exact_.at_nodes(cloud);
  }

 private:
  static constexpr double young = 1000;
  Traction traction_;
  UnitCube<3> domain_;
  Lame material_;
  ExactElasticity<3, Waves> exact_;

  /// Sides of the cube come in pairs along an axis, the farther second.
  bool is_loaded(int side) const {
    return side % 2 == 1 && (traction_ == Traction::three || side == 1);
  }
};

}  // namespace

/// Manufactured displacements in a cube with E = 1000, body forces and tractions derived.
/// Source: manufactured.
ProblemEntry problem_elastic_cube() {
  return {
      {"elastic_cube",
       "manufactured elasticity in a cube, displacements given but on one face or three",
       {{"traction", "three", "faces with given tractions: one (x = 1) | three (y = 1, z = 1 too)"},
        {"nu", "0.3", "Poisson's ratio, 0 to 0.4999"}}},
      [](const Options& options) -> AnyProblem {
        return std::make_unique<ElasticCube>(
            options.number("nu", 0, 0.4999),
            options.choice<Traction>("traction",
                                     {{"one", Traction::one}, {"three", Traction::three}}));
      }};
}

}  // namespace strongpoint
