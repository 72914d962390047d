#include <array>

#include "problems/core/elastic_problem.hpp"
#include "problems/core/jet.hpp"

namespace strongpoint {
namespace {

using Point2 = Point<2>;

/// (u, v, lambda, mu): displacements in units of length, moduli in units of stress.
struct Manufactured {
  template <class T>
  std::array<T, 4> operator()(const std::array<T, 2>& x) const {
    return {sin(2.0 * x[0] + 1.0) * cos(1.5 * x[1]), cos(x[0] + 0.5) * sin(2.0 * x[1] + 0.5),
            2.0 + exp(x[0]) * cos(x[1]), 1.0 + 0.5 * sin(2.0 * x[0]) + 0.5 * x[1] * x[1]};
  }
};

/// The unit square, clamped to the exact displacements at x = 0 and y = 0, with exact tractions on
/// the other sides.
class GradedMaterial final : public ElasticProblem<2> {
 public:
  using ElasticProblem<2>::ElasticProblem;

  const Domain<2>& domain() const override { return domain_; }
  Lame material(const Place<2>& place) const override {
    const auto jets = jets_at<2, 1>(Manufactured{}, place.x);
    return {jets[2].value(), jets[3].value()};
  }
  bool varies() const override { return true; }
  LameGradient<2> material_gradient(const Place<2>& place) const override {
    const auto jets = jets_at<2, 1>(Manufactured{}, place.x);
    LameGradient<2> gradient;
    for (int j = 0; j < 2; ++j) {
      gradient.lambda[j] = jets[2].derivative(partial<2>(j));
      gradient.mu[j] = jets[3].derivative(partial<2>(j));
    }
    return gradient;
  }
  /// -div sigma.
  Point2 body_force(const Place<2>& place) const override {
    const auto jets = jets_at<2, 2>(Manufactured{}, place.x);
    const auto slope = [&](int function, int j) {
      return jets[function].derivative(partial<2>(j));
    };
    const double divergence = slope(0, 0) + slope(1, 1);
    Point2 force;
    for (int i = 0; i < 2; ++i) {
      force[i] = -slope(2, i) * divergence;
      for (int j = 0; j < 2; ++j) {
        force[i] -= slope(3, j) * (slope(i, j) + slope(j, i)) +
                    jets[2].value() * jets[j].derivative(partial<2>(i, j)) +
                    jets[3].value() * (jets[i].derivative(partial<2>(j, j)) +
                                       jets[j].derivative(partial<2>(i, j)));
      }
    }
    return force;
  }
  Derivatives<2> measured_derivatives() const override { return first_derivatives(); }
  Known known(int, int side) const override { return side % 2 == 0 ? Known::value : Known::flux; }
  double given(int field, int side, const Point2& x) const override {
    if (known(field, side) == Known::value) return displacement(x)[field];
    return stress_at(x).row(field).dot(domain_.normal(side, x));
  }

  std::vector<std::string> quantities() const override {
    return {"displacement_error", "stress_error"};
  }
  std::vector<double> measure(const Solution<2>& solution) const override {
    return errors_at_nodes(solution);
  }

 protected:
  std::optional<ElasticNodes> exact_at_nodes(const PointCloud<2>& cloud) const override {
    Points<2> displacements(2, cloud.size());
    Points<3> stresses(3, cloud.size());
    for (int i = 0; i < cloud.size(); ++i) {
      displacements.col(i) = displacement(cloud.nodes.col(i));
      stresses.col(i) = tensor_components<2>(stress_at(cloud.nodes.col(i)));
    }
    return ElasticNodes{displacements, stresses};
  }

 private:
  UnitCube<2> domain_;

  static Point2 displacement(const Point2& x) {
    const auto jets = jets_at<2, 1>(Manufactured{}, x);
    return {jets[0].value(), jets[1].value()};
  }
  Eigen::Matrix2d stress_at(const Point2& x) const {
    const auto jets = jets_at<2, 1>(Manufactured{}, x);
    Eigen::Matrix2d gradient;
    for (int i = 0; i < 2; ++i) {
      for (int j = 0; j < 2; ++j) gradient(i, j) = jets[i].derivative(partial<2>(j));
    }
    return stress<2>({jets[2].value(), jets[3].value()}, gradient);
  }
};

}  // namespace

/// Elasticity with smoothly varying moduli on the unit square, plane strain: (4.21) where it is
/// meant to serve. Source: manufactured; the equation is thesis (4.21), corrected.
ProblemEntry problem_graded_material() {
  return {{"graded_material",
           "smoothly varying moduli on the unit square, plane strain, manufactured solution",
           {unknowns_option()}},
          [](const Options& options) -> AnyProblem {
            return std::make_unique<GradedMaterial>(chosen_unknowns(options));
          }};
}

}  // namespace strongpoint
