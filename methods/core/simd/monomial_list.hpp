#pragma once

namespace strongpoint {

/// Monomials as kernels evaluate them, by degree: a is that of `parent` times a coordinate.
struct MonomialList {
  int terms;          ///< m
  const int* axis;    ///< (m) the coordinate; -1 for the constant
  const int* parent;  ///< (m) -1 for the constant, listed or not
};

}  // namespace strongpoint
