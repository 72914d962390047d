#pragma once

#include <string>
#include <utility>
#include <vector>

#include "problems/core/exact_elasticity.hpp"
#include "problems/core/radial_lame.hpp"

namespace strongpoint {

/// A part, cut by symmetry planes, of a tube (2D, plane strain) or hollow sphere (3D) with a
/// pressure of 1 inside and a free outside, E = 1000, judged by Lame's solution. `Region` is a
/// domain between two radii that are the first arguments of its constructor, with a Side::inner.
template <int Dim, class Region>
class ThickWalled final : public ElasticProblem<Dim> {
 public:
  /// Takes the radii, Poisson's ratio, the symmetry planes and further arguments of the region.
  template <class... More>
  ThickWalled(double a, double b, double nu, std::vector<SymmetryPlane> planes, Unknowns unknowns,
              More&&... more)
      : ElasticProblem<Dim>(unknowns),
        domain_(a, b, std::forward<More>(more)...),
        planes_(std::move(planes)),
        material_(lame_constants(young, nu)),
        exact_(RadialLame<Dim>(a, b, pressure, material_), material_) {}

  const Domain<Dim>& domain() const override { return domain_; }
  Lame material(const Place<Dim>&) const override { return material_; }
  std::vector<SymmetryPlane> symmetry_planes() const override { return planes_; }
  Derivatives<Dim> measured_derivatives() const override { return this->first_derivatives(); }
  Known known(int field, int side) const override {
    for (const SymmetryPlane& plane : planes_) {
      if (plane.side == side && plane.axis == field) return Known::value;
    }
    return Known::flux;
  }
  double given(int field, int side, const Point<Dim>& x) const override {
    return side == Region::inner ? -pressure * domain_.normal(side, x)[field] : 0;
  }

  std::vector<std::string> quantities() const override {
    return {"displacement_error", "stress_error"};
  }
  std::vector<double> measure(const Solution<Dim>& solution) const override {
    return this->errors_at_nodes(solution);
  }

 protected:
  std::optional<ElasticNodes> exact_at_nodes(const PointCloud<Dim>& cloud) const override {
    return exact_.at_nodes(cloud);
  }

 private:
  static constexpr double young = 1000;
  static constexpr double pressure = 1;
  Region domain_;
  std::vector<SymmetryPlane> planes_;
  Lame material_;
  ExactElasticity<Dim, RadialLame<Dim>> exact_;
};

}  // namespace strongpoint
