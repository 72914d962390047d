#pragma once

#include "problems/core/simd/front_kernel.hpp"

namespace strongpoint {

/// What products with a panel work on.
template <class Real>
struct PanelTask {
  const Real* panel;  ///< (tiles, pivots, tile), as in `FrontTask`
  int rest;           ///< vectors in it
  int pivots;
  Real* values;  ///< (pivots)
  Real* beside;  ///< (rest rounded up to tiles)
};

/// The sum over the pivots of their value times the panel's numbers becomes `beside`.
STRONGPOINT_SIMD_KERNEL(multiply_panel, PanelTask<double>);
STRONGPOINT_SIMD_KERNEL(multiply_panel, PanelTask<float>);

/// The sum over what is `beside`, zeros in the end, times the panel's numbers is taken from
/// `values`.
STRONGPOINT_SIMD_KERNEL(subtract_turned_panel, PanelTask<double>);
STRONGPOINT_SIMD_KERNEL(subtract_turned_panel, PanelTask<float>);

}  // namespace strongpoint
