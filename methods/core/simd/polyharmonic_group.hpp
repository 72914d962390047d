#pragma once

#include "methods/core/simd/lane_algebra.hpp"
#include "methods/core/simd/lane_gather.hpp"
#include "methods/core/simd/polyharmonic_kernel.hpp"

// For kernel sources only: the storage of stencils whose polyharmonic weights are computed side by
// side, and the choice of the nodes that determine the polynomials.

namespace strongpoint::STRONGPOINT_SIMD_PATH {

/// Smallest pivot of the polynomials over the largest entry of its column that is served here: far
/// from where the one by one path refuses (rank_tolerance, 1e-11).
inline constexpr double polynomial_tolerance = 1e-8;

/// Buffers of a group of stencils. Nodes are in the order in which the polynomials choose them.
struct PolyharmonicGroup {
  LaneStencils stencils;
  Pack* place;             ///< (n) where a node stands in its stencil
  LaneMatrix polynomials;  ///< (n, m) L1 and U; below them first L2, then T
  Pack* inverse;           ///< (m) of the diagonal of U
  LaneMatrix chosen;       ///< (m, m) r^phs between the chosen nodes
  LaneMatrix mixed;        ///< (n - m, m) between the others and the chosen ones
  LaneMatrix coupling;     ///< (n - m, m) C = mixed - T chosen
  LaneMatrix projected;    ///< (n - m, n - m) r^phs in the null space, then its factors
  Pack* inverse_pivots;    ///< (n - m)
  LaneMatrix radial;       ///< (n, columns) right-hand sides, then weights of the nodes m to n
  LaneMatrix weights;      ///< (m, columns) right-hand sides, then weights of the nodes 0 to m
};

inline PolyharmonicGroup make_group(const PolyharmonicTask& task) {
  const long n = task.table.size;
  const long m = task.terms;
  const long rest = n - m;
  const long columns = polyharmonic_columns(task.derivatives);
  LaneRoom room(task.room);
  PolyharmonicGroup group;
  group.stencils.z = room.packs(n * task.dimension);
  group.stencils.rho = room.packs(n);
  group.place = room.packs(n);
  group.polynomials = room.matrix(n, m);
  group.inverse = room.packs(m);
  group.chosen = room.matrix(m, m);
  group.mixed = room.matrix(rest, m);
  group.coupling = room.matrix(rest, m);
  group.projected = room.matrix(rest, rest);
  group.inverse_pivots = room.packs(rest);
  group.radial = {room.packs(n * columns), 1, n};
  group.weights = {room.packs(m * columns), 1, m};
  return group;
}

/// z^exponents.
template <int Dim>
Pack monomial(const Pack* z, const int* exponents) {
  Pack value = all(1);
  for (int c = 0; c < Dim; ++c) {
    for (int k = 0; k < exponents[c]; ++k) value = value * z[c];
  }
  return value;
}

/// Exchanges `count` packs of two rows in some lanes.
inline void exchange(unsigned bits, Pack* a, Pack* b, int count) {
  for (int e = 0; e < count; ++e) {
    const Pack before = a[e];
    a[e] = choose(bits, b[e], before);
    b[e] = choose(bits, before, b[e]);
  }
}

/// Brings, in each lane, the node with the largest entry of column k to row k, where rows have
/// `filled` entries. Gives that entry's size.
template <int Dim>
Pack exchange_nodes(const PolyharmonicGroup& group, int n, int k, int filled) {
  Pack largest = all(0);
  for (int i = k; i < n; ++i) largest = max(largest, abs(group.polynomials(i, k)));
  Pack row = all(k);
  Pack here = all(n);
  for (int i = n - 1; i >= k; --i) {
    here = here - all(1);
    row = choose_less(abs(group.polynomials(i, k)), largest, row, here);
  }
  double rows[lanes];
  store(rows, row);
  unsigned left = less(all(k), row);
  for (int lane = 0; lane < lanes; ++lane) {
    if ((left >> lane & 1U) == 0) continue;
    const int i = static_cast<int>(rows[lane]);
    const unsigned bits = less(abs(row - all(i)), all(0.5));
    left &= ~bits;
    exchange(bits, group.stencils.z + k * Dim, group.stencils.z + i * Dim, Dim);
    exchange(bits, group.place + k, group.place + i, 1);
    exchange(bits, &group.polynomials(k, 0), &group.polynomials(i, 0), filled);
  }
  return largest;
}

/// Fills a column with a monomial at all nodes. Gives its largest entry's size.
template <int Dim>
Pack fill_monomial(const PolyharmonicGroup& group, int n, int k, const int* exponents) {
  Pack largest = all(0);
  for (int i = 0; i < n; ++i) {
    const Pack value = monomial<Dim>(group.stencils.z + i * Dim, exponents);
    group.polynomials(i, k) = value;
    largest = max(largest, abs(value));
  }
  return largest;
}

/// LU of the polynomials, nodes being exchanged, a few columns at a time. Gives the bits of lanes
/// where the columns are safely independent.
template <int Dim>
unsigned factorise_polynomials(const PolyharmonicTask& task, const PolyharmonicGroup& group) {
  const int n = task.table.size;
  const LaneMatrix& lu = group.polynomials;
  unsigned good = every_lane;
  for (int i = 0; i < n; ++i) group.place[i] = all(i);
  for (int begin = 0; begin < task.terms; begin += panel) {
    const int end = begin + panel < task.terms ? begin + panel : task.terms;
    Pack column[panel];
    for (int k = begin; k < end; ++k) {
      column[k - begin] = fill_monomial<Dim>(group, n, k, task.exponents + k * Dim);
    }
    solve_lower(begin, lu, nullptr, end - begin, lu.block(0, begin));
    subtract_product(n - begin, end - begin, lu.block(begin, begin), lu.block(begin, 0),
                     lu.block(0, begin), begin);
    for (int k = begin; k < end; ++k) {
      const Pack pivot = exchange_nodes<Dim>(group, n, k, end);
      good &= less(all(polynomial_tolerance) * column[k - begin], pivot);
      const Pack inverse = all(1) / lu(k, k);
      group.inverse[k] = inverse;
      for (int i = k + 1; i < n; ++i) lu(i, k) = lu(i, k) * inverse;
      for (int j = k + 1; j < end; ++j) {
        const Pack factor = lu(k, j);
        for (int i = k + 1; i < n; ++i) lu(i, j) = lu(i, j) - lu(i, k) * factor;
      }
    }
  }
  return good;
}

}  // namespace strongpoint::STRONGPOINT_SIMD_PATH
