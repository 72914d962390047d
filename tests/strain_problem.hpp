#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "problems/core/elastic_problem.hpp"

namespace strongpoint {

/// Homogeneous strain on any domain, which every form of degree 1 has to give exactly:
/// displacements known on some sides, tractions on all others, normal displacements of zero on
/// symmetry planes.
template <int Dim>
class HomogeneousStrain : public ElasticProblem<Dim> {
 public:
  using Tensor = Eigen::Matrix<double, Dim, Dim>;

  HomogeneousStrain(const Domain<Dim>& domain, std::vector<std::string> clamped,
                    std::vector<SymmetryPlane> planes = {},
                    Unknowns unknowns = Unknowns::displacement)
      : ElasticProblem<Dim>(unknowns),
        domain_(domain),
        clamped_(std::move(clamped)),
        planes_(std::move(planes)) {}

  /// With planes, a stretch along the axes about the origin.
  Tensor gradient() const {
    Tensor result = Tensor::Zero();
    for (int i = 0; i < Dim; ++i) {
      for (int j = 0; j < Dim; ++j) {
        result(i, j) = i == j ? 0.3 - 0.1 * i : planes_.empty() ? 0.4 - 0.5 * i + 0.1 * j : 0.0;
      }
    }
    return result;
  }
  Point<Dim> displacement(const Point<Dim>& x) const {
    const Point<Dim> shift = Point<Dim>::Constant(planes_.empty() ? 0.1 : 0.0);
    return gradient() * x + shift;
  }

  const Domain<Dim>& domain() const override { return domain_; }
  Lame material(const Place<Dim>&) const override { return lame; }
  std::vector<SymmetryPlane> symmetry_planes() const override { return planes_; }
  Known known(int field, int side) const override {
    for (const SymmetryPlane& plane : planes_) {
      if (plane.side == side) return plane.axis == field ? Known::value : Known::flux;
    }
    const std::string& name = domain_.sides()[side];
    const bool is_clamped = std::find(clamped_.begin(), clamped_.end(), name) != clamped_.end();
    return is_clamped ? Known::value : Known::flux;
  }
  double given(int field, int side, const Point<Dim>& x) const override {
    if (known(field, side) == Known::value) return displacement(x)[field];
    return (stress<Dim>(lame, gradient()) * domain_.normal(side, x))[field];
  }
  std::vector<std::string> quantities() const override { return {"largest_error"}; }
  std::vector<double> measure(const Solution<Dim>& solution) const override {
    double largest = 0;
    for (int i = 0; i < solution.cloud.size(); ++i) {
      const Point<Dim> error =
          solution.fields.col(i).template head<Dim>() - displacement(solution.cloud.nodes.col(i));
      largest = std::max(largest, error.norm());
    }
    return {largest};
  }

 private:
  inline static const Lame lame = lame_constants(10, 0.3);
  const Domain<Dim>& domain_;
  std::vector<std::string> clamped_;
  std::vector<SymmetryPlane> planes_;
};

}  // namespace strongpoint
