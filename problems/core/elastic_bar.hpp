#pragma once

#include "problems/core/elastic_problem.hpp"
#include "problems/core/norms.hpp"
#include "problems/core/transient_problem.hpp"
#include "problems/core/wave_bar.hpp"

namespace strongpoint {

/// An elastic bar 1 x 0.2 (x 0.2), clamped at x = 0, pulled at x = 1, free elsewhere.
template <int Dim>
class ElasticBar final : public ElasticProblem<Dim> {
 public:
  /// Sides of the box at x = 0 and x = 1.
  enum Side { clamped, pulled };

  /// Takes the stress at x = 1, the material and its density.
  ElasticBar(double stress, const Lame& material, double density)
      : stress_(stress), material_(material), density_(density) {}

  const Domain<Dim>& domain() const override { return domain_; }
  Lame material(const Place<Dim>&) const override { return material_; }
  double inertia(int, const Place<Dim>&) const override { return density_; }
  Known known(int, int side) const override { return side == clamped ? Known::value : Known::flux; }
  double given(int field, int side, const Point<Dim>&) const override {
    return side == pulled && field == 0 ? stress_ : 0;
  }
  bool owns_corners(int side) const override { return side == pulled; }
  Derivatives<Dim> measured_derivatives() const override {
    return ElasticProblem<Dim>::first_derivatives();
  }
  std::vector<std::string> quantities() const override { return {}; }
  std::vector<double> measure(const Solution<Dim>&) const override { return {}; }
  /// sigma_xx at the nodes, (N).
  Eigen::VectorXd axial_stress(const Solution<Dim>& solution) const {
    return this->nodal_stresses(solution).row(0);
  }

 private:
  static Point<Dim> lengths() {
    Point<Dim> all = Point<Dim>::Constant(0.2);
    all[0] = 1;
    return all;
  }
  double stress_;
  Lame material_;
  double density_;
  Box<Dim> domain_{lengths()};
};

/// Waves in that bar after a pulse -100 exp(-100 (t - 0.3)^2) of the stress at x = 1. With nu = 0
/// they are those of a string, and `stress_error` is the relative 2-norm of the error of sigma_xx
/// over all nodes; with any other nu there is no closed form, and `stress_peak` is the largest
/// |sigma_xx|.
template <int Dim>
class BarWaves final : public TransientProblem<Dim> {
 public:
  explicit BarWaves(double nu)
      : nu_(nu),
        material_(lame_constants(young, nu)),
        pulse_{-100, 100, 0.3, 1},  // thesis (4.42)
        space_(pulse_.force, material_, density) {}

  const SteadyProblem<Dim>& space() const override { return space_; }
  double load(double time) const override { return pulse_.shape(time); }
  double wave_speed() const override {
    return std::sqrt((material_.lambda + 2 * material_.mu) / density);
  }
  double end_time() const override { return 2.8; }
  double time_step() const override { return 7e-4; }
  std::vector<std::string> quantities() const override {
    return {nu_ == 0 ? "stress_error" : "stress_peak"};
  }
  std::vector<double> measure(const Solution<Dim>& solution, double time) const override {
    const Eigen::VectorXd stress = space_.axial_stress(solution);
    if (nu_ != 0) return {stress.cwiseAbs().maxCoeff()};
    return {relative_error(stress, exact(solution.cloud, time))};
  }
  std::vector<NodeArray> derived_fields(const Solution<Dim>& solution, double time) const override {
    std::vector<NodeArray> arrays = space_.derived_fields(solution);
    if (nu_ == 0) {
      arrays.push_back({"sigma_xx_exact", exact(solution.cloud, time).transpose()});
    }
    return arrays;
  }

 private:
  static constexpr double young = 100;    // thesis 4.5.1
  static constexpr double density = 100;  // thesis 4.5.1
  double nu_;
  Lame material_;
  BarPulse pulse_;
  ElasticBar<Dim> space_;

  Eigen::VectorXd exact(const PointCloud<Dim>& cloud, double time) const {
    Eigen::VectorXd stress(cloud.size());
    for (int i = 0; i < cloud.size(); ++i) {
      stress[i] = pulse_.section_force(cloud.nodes(0, i), time);
    }
    return stress;
  }
};

}  // namespace strongpoint
