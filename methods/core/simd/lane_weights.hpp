#pragma once

#include "methods/core/simd/lane_formula.hpp"
#include "methods/core/simd/lane_gather.hpp"
#include "methods/core/simd/lane_numbers.hpp"
#include "methods/core/simd/taylor_stencils.hpp"

namespace strongpoint::STRONGPOINT_SIMD_PATH {

/// Fills `to` with the weights of a group's nodes, the squares of whose distances are in
/// `group.rho` and may be lost: zero at the centre, which comes first, and in padding. Returns
/// `to`, or null for ones, which may stay in padding, where monomials vanish.
template <int Dim>
const Pack* weigh_nodes(const StencilTable& table, int first, const NodeWeights& weights,
                        const LaneStencils& group, Pack* to) {
  const int size = table.size;
  if (weights.formula != nullptr) {
    const LaneFormula formula(*weights.formula);
    for (int j = 1; j < size; ++j) to[j] = formula.at_square(group.rho[j]);
  } else if (weights.volumes != nullptr) {
    Pack unit = all(1) / group.radius;
    for (int c = 1; c < Dim; ++c) unit = unit / group.radius;
    gather_of_nodes(table, first, weights.volumes, unit, to);
  } else if (weights.squared != nullptr) {
    group.rho[0] = all(1);
    for (int j = 1; j < size; ++j) group.rho[j] = sqrt(group.rho[j]);
    weights.squared(weights.function, reinterpret_cast<const double*>(group.rho),
                    reinterpret_cast<double*>(to), static_cast<long>(size) * lanes);
  } else {
    return nullptr;
  }
  to[0] = all(0);
  for (int j = group.least; j < size; ++j) to[j] = choose_less(all(j), group.size, to[j], all(0));
  return to;
}

/// Gathers the stencils of anchors `first` and following as `gather_squares` does and weighs their
/// nodes as `weigh_nodes` does.
template <int Dim>
const Pack* gather_weighed(const TaylorStencils& stencils, int first, LaneStencils& group) {
  group.z = reinterpret_cast<Pack*>(stencils.z);
  group.rho = reinterpret_cast<Pack*>(stencils.rho);
  gather_squares<Dim>(stencils.table, first, group);
  return weigh_nodes<Dim>(stencils.table, first, stencils.weights, group,
                          reinterpret_cast<Pack*>(stencils.squared));
}

}  // namespace strongpoint::STRONGPOINT_SIMD_PATH
