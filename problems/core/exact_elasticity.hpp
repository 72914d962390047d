#pragma once

#include "problems/core/elastic_problem.hpp"
#include "problems/core/jet.hpp"
#include "problems/core/norms.hpp"

namespace strongpoint {

/// What follows from exact displacements, given as a functor that is generic in its number type,
/// `std::array<T, Dim> operator()(const std::array<T, Dim>&)`, in a homogeneous material.
template <int Dim, class Displacement>
class ExactElasticity {
 public:
  using Tensor = Eigen::Matrix<double, Dim, Dim>;

  ExactElasticity(Displacement displacement, const Lame& material)
      : displacement_(displacement), material_(material) {}

  Point<Dim> displacement(const Point<Dim>& x) const {
    const auto jets = jets_at<Dim, 1>(displacement_, x);
    Point<Dim> u;
    for (int i = 0; i < Dim; ++i) u[i] = jets[i].value();
    return u;
  }
  Tensor stress_at(const Point<Dim>& x) const {
    const auto jets = jets_at<Dim, 1>(displacement_, x);
    Tensor gradient;
    for (int i = 0; i < Dim; ++i) {
      for (int j = 0; j < Dim; ++j) gradient(i, j) = jets[i].derivative(partial<Dim>(j));
    }
    return stress<Dim>(material_, gradient);
  }
  /// -div sigma.
  Point<Dim> body_force(const Point<Dim>& x) const {
    const auto jets = jets_at<Dim, 2>(displacement_, x);
    Point<Dim> force = Point<Dim>::Zero();
    for (int i = 0; i < Dim; ++i) {
      for (int j = 0; j < Dim; ++j) {
        force[i] -= material_.mu * jets[i].derivative(partial<Dim>(j, j)) +
                    (material_.lambda + material_.mu) * jets[j].derivative(partial<Dim>(i, j));
      }
    }
    return force;
  }
  /// Relative 2-norm of the error of the displacements over all nodes.
  double displacement_error(const Solution<Dim>& solution) const {
    return relative_error(solution.fields.topRows(Dim), displacements(solution.cloud));
  }
  /// (Dim, N) exact displacements at the nodes.
  Points<Dim> displacements(const PointCloud<Dim>& cloud) const {
    Points<Dim> exact(Dim, cloud.size());
    for (int i = 0; i < exact.cols(); ++i) exact.col(i) = displacement(cloud.nodes.col(i));
    return exact;
  }
  /// Exact stress components at the nodes, in the order of `stress_names`.
  Eigen::MatrixXd stresses(const PointCloud<Dim>& cloud) const {
    Eigen::MatrixXd exact(Dim * (Dim + 1) / 2, cloud.size());
    for (int i = 0; i < exact.cols(); ++i) {
      exact.col(i) = tensor_components<Dim>(stress_at(cloud.nodes.col(i)));
    }
    return exact;
  }
  /// Both at the nodes.
  ElasticNodes at_nodes(const PointCloud<Dim>& cloud) const {
    return {displacements(cloud), stresses(cloud)};
  }

 private:
  Displacement displacement_;
  Lame material_;
};

}  // namespace strongpoint
