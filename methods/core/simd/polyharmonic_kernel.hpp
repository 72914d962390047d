#pragma once

#include <cstdint>

#include "methods/core/simd/path.hpp"
#include "methods/core/simd/stencil_table.hpp"

namespace strongpoint {

/// A term c x^a f^(m)(s) of a derivative of a radial function f(s), s = |x|^2.
struct RadialTerm {
  double coefficient;
  int exponents[3];
  int outer;  ///< m
};

/// What the kernel `polyharmonic_weights` works on: weights of r^phs with polynomials at all
/// evaluation points of some anchors whose stencils have the same number of nodes.
struct PolyharmonicTask {
  StencilTable table;
  int dimension;
  int phs;               ///< odd
  int terms;             ///< m, monomials, at most table.size
  const int* exponents;  ///< (Dim, m) of the monomials, by degree

  int derivatives;            ///< D
  const int* orders;          ///< (Dim, D) how often each coordinate is differentiated
  const RadialTerm* radial;   ///< terms of each derivative of r^phs
  const int* radial_offsets;  ///< (D + 1)
  const double* factors;      ///< (m, D) a!/(a - d)! of d^d z^a, zero where it vanishes

  const double* points;               ///< (Dim, P) evaluation points
  const double* spans;                ///< (Dim, P) of the sites, null: zeros
  const std::int64_t* point_offsets;  ///< (A + 1) of the anchors in `point_ids`
  const int* point_ids;               ///< evaluation points, by anchor

  double* values;                     ///< weights, the D values of an entry side by side
  const std::int64_t* value_offsets;  ///< (P + 1) first entry of each point
  unsigned char* served;              ///< (table.count) becomes 1 where the weights are written
  double* room;                       ///< polyharmonic_room numbers, 64-byte aligned
};

/// Points of an anchor times derivatives that the kernel treats at a time: at least those of one
/// point.
constexpr int polyharmonic_columns(int derivatives) {
  return derivatives < 16 ? 16 / derivatives * derivatives : derivatives;
}

/// Numbers that `room` has to hold, for the widest path.
constexpr std::size_t polyharmonic_room(int dimension, int nodes, int terms, int derivatives) {
  const std::size_t n = nodes;
  const std::size_t m = terms;
  const std::size_t rest = n - m;
  const std::size_t columns = polyharmonic_columns(derivatives);
  return 8 * (n * (dimension + 4 + m) + m * m + 2 * rest * m + rest * rest + columns * (n + m));
}

/// Weights of a stencil's nodes from the saddle-point system of r^phs and the monomials. A stencil
/// is left alone where the polynomials are not safely independent on it, a pivot is not safely
/// positive or a weight is not finite.
/// The null space of the constraints is spanned by [-T^T; I], T = P2 P1^-1, where P1 holds the rows
/// that a pivoted LU of the polynomials chooses (discrete Leja points: Bos, De Marchi, Sommariva,
/// Vianello 2010): half the work of orthogonal transformations, and T stays of moderate size.
STRONGPOINT_SIMD_KERNEL(polyharmonic_weights, PolyharmonicTask);

}  // namespace strongpoint
