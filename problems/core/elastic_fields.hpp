#pragma once

#include <optional>
#include <string>
#include <vector>

#include "problems/core/elasticity.hpp"
#include "problems/core/node_array.hpp"

namespace strongpoint {

/// What is known of an elastic body at its nodes.
struct ElasticNodes {
  Eigen::MatrixXd fields;    ///< (fields, N) displacements, in the mixed form the pressure too
  Eigen::MatrixXd stresses;  ///< (Dim (Dim + 1) / 2, N) in the order of `stress_names`, or empty
};

/// lambda / (Dim lambda + 2 mu), by which the sum of the normal stresses is multiplied to give
/// lambda div u: in 2D the stress across the plane (there it is Poisson's ratio), in the mixed form
/// the pressure but for its sign. Right for an infinite lambda as well.
template <int Dim>
double volumetric_share(const Lame& material) {
  return 1 / (Dim + 2 * material.mu / material.lambda);
}

/// Von Mises' equivalent of a stress in the order of `stress_names`: sqrt(3/2 s:s), s its deviator,
/// in 2D with the stress across the plane that plane strain has. Source: von Mises 1913.
template <int Dim>
double von_mises(const Eigen::Matrix<double, Dim*(Dim + 1) / 2, 1>& stress, const Lame& material);

/// What an elastic body shows beside its fields, called `names`: `displacement` as one array of
/// three components (missing ones zero), by which ParaView warps; unless stresses are empty,
/// `sigma_xx`, `tau_xy` and so on and `von_mises`; where the exact state is given the error of each
/// field and stress. `materials` are those at the nodes, (N).
template <int Dim>
std::vector<NodeArray> elastic_arrays(const std::vector<std::string>& names,
                                      const std::vector<Lame>& materials,
                                      const ElasticNodes& computed,
                                      const std::optional<ElasticNodes>& exact);

}  // namespace strongpoint
