#pragma once

#include "methods/core/simd/lane_algebra.hpp"
#include "methods/core/simd/lane_numbers.hpp"
#include "methods/core/simd/lane_points.hpp"

namespace strongpoint::STRONGPOINT_SIMD_PATH {

/// Fills the derivatives (terms, D) of monomials at the p-th points of a group, relative to the
/// anchor over R, all times R^-order. `per_radius` is 1 / R, `values` room for the monomials.
template <int Dim>
void fill_right_sides(const LanePoints<Dim>& points, long p, Pack per_radius,
                      const MonomialList& monomials, const DerivativeTable& derivatives,
                      Pack* values, const LaneMatrix& right_sides) {
  Pack at[Dim];
  points.find(p, at);
  for (int c = 0; c < Dim; ++c) at[c] = at[c] * per_radius;
  evaluate_list(monomials, at, values);
  for (int d = 0; d < derivatives.count; ++d) {
    Pack scale = all(1);
    for (int q = 0; q < derivatives.order[d]; ++q) scale = scale * per_radius;
    const long row = static_cast<long>(d) * monomials.terms;
    for (int a = 0; a < monomials.terms; ++a) {
      const double factor = derivatives.factors[row + a];
      const int power = derivatives.powers[row + a];
      right_sides(a, d) = factor == 0 ? all(0)
                          : power < 0 ? all(factor) * scale
                                      : all(factor) * values[power] * scale;
    }
  }
}

}  // namespace strongpoint::STRONGPOINT_SIMD_PATH
