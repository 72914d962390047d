#pragma once

#include "methods/core/simd/pack.hpp"

namespace strongpoint::STRONGPOINT_SIMD_PATH {

/// Number of monomials in Dim variables of degree 1 to `degree`.
template <int Dim>
constexpr int monomials_up_to(int degree) {
  int count = 1;
  for (int c = 1; c <= Dim; ++c) count = count * (degree + c) / c;
  return count - 1;
}

/// Monomials of degree 1 to Degree, ordered as Derivatives::between_orders: by degree, then x
/// before y before z.
template <int Dim, int Degree>
struct MonomialTable {
  static constexpr int size = monomials_up_to<Dim>(Degree);
  int power[size][Dim] = {};
  int axis[size] = {};    ///< the first variable it holds
  int parent[size] = {};  ///< the monomial divided by that variable, -1 for the constant

  constexpr MonomialTable() {
    int next = 0;
    for (int degree = 1; degree <= Degree; ++degree) {
      for (int code = 0; code <= degree * (degree + 1) + degree; ++code) {
        // In 3D the power of x falls with code / (degree + 1), that of z rises with the rest.
        const int left = Dim == 3 ? code / (degree + 1) : code;
        const int last = Dim == 3 ? code % (degree + 1) : left;
        if (Dim == 1 ? code > 0 : (left > degree || last > left)) continue;
        power[next][0] = Dim == 1 ? degree : degree - left;
        if (Dim == 2) power[next][Dim - 1] = left;
        if (Dim == 3) {
          power[next][Dim - 2] = left - last;
          power[next][Dim - 1] = last;
        }
        ++next;
      }
    }
    for (int a = 0; a < size; ++a) {
      while (power[a][axis[a]] == 0) ++axis[a];
      parent[a] = -1;
      for (int b = 0; b < a; ++b) {
        if (holds_product(a, b, axis[a])) parent[a] = b;
      }
    }
  }

  /// Place of the product of monomials a and b.
  constexpr int product(int a, int b) const {
    for (int place = 0; place < size; ++place) {
      bool same = true;
      for (int c = 0; c < Dim; ++c) same = same && power[place][c] == power[a][c] + power[b][c];
      if (same) return place;
    }
    return -1;
  }

 private:
  constexpr bool holds_product(int a, int b, int variable) const {
    for (int c = 0; c < Dim; ++c) {
      if (power[a][c] != power[b][c] + (c == variable ? 1 : 0)) return false;
    }
    return true;
  }
};

/// The sums that make up the moment matrix of monomials up to a degree: entries (a, b) with the
/// same product of monomials are the same sum.
template <int Dim, int Degree>
struct MomentTable {
  static constexpr int terms = monomials_up_to<Dim>(Degree);
  static constexpr int size = monomials_up_to<Dim>(2 * Degree) - Dim;  ///< of degree 2 and more
  int first[size] = {};  ///< sum s is over first[s] times second[s]
  int second[size] = {};
  int sum[terms * (terms + 1) / 2] = {};  ///< of each entry of the lower triangle, row after row

  constexpr MomentTable() {
    const MonomialTable<Dim, 2 * Degree> all_products;
    for (int a = 0, entry = 0; a < terms; ++a) {
      for (int b = 0; b <= a; ++b, ++entry) {
        const int place = all_products.product(a, b) - Dim;
        sum[entry] = place;
        first[place] = a;
        second[place] = b;
      }
    }
  }
};

template <int Dim, int Degree>
inline constexpr MonomialTable<Dim, Degree> monomial_table{};
template <int Dim, int Degree>
inline constexpr MomentTable<Dim, Degree> moment_table{};

/// The monomials of degree 1 to Degree at z.
template <int Dim, int Degree>
[[gnu::always_inline]] inline void evaluate_monomials(const Pack* z, Pack* basis) {
  constexpr int terms = monomials_up_to<Dim>(Degree);
#pragma GCC unroll 64
  for (int a = 0; a < terms; ++a) {
    const int axis = monomial_table<Dim, Degree>.axis[a];
    const int parent = monomial_table<Dim, Degree>.parent[a];
    basis[a] = parent < 0 ? z[axis] : basis[parent] * z[axis];
  }
}

/// Weights of nodes that all are one.
struct EqualWeights {};

/// A number of node j times its weight.
[[gnu::always_inline]] inline Pack weighted(EqualWeights, int, Pack number) { return number; }
[[gnu::always_inline]] inline Pack weighted(const Pack* w, int j, Pack number) {
  return w[j] * number;
}

/// Sums that stay in registers at a time, beside the monomials and, where they are others, the
/// weighted ones.
template <class PackWeights>
inline constexpr int sums_at_once = lanes == 8 ? 12 : 8;
template <>
inline constexpr int sums_at_once<EqualWeights> = lanes == 8 ? 16 : 8;

/// Fills sums Begin to End - 1 of the moment table, over nodes 1 to n - 1.
template <int Dim, int Degree, int Begin, int End, class PackWeights>
[[gnu::always_inline]] inline void sum_some_moments(const Pack* z, PackWeights w, int n,
                                                    Pack* sums) {
  using Table = MomentTable<Dim, Degree>;
  constexpr const Table& table = moment_table<Dim, Degree>;
  Pack some[End - Begin];
#pragma GCC unroll 32
  for (int s = 0; s < End - Begin; ++s) some[s] = all(0);
  for (int j = 1; j < n; ++j) {
    Pack basis[Table::terms];
    Pack by_weight[Table::terms];
    evaluate_monomials<Dim, Degree>(z + static_cast<long>(j) * Dim, basis);
#pragma GCC unroll 64
    for (int a = 0; a < Table::terms; ++a) by_weight[a] = weighted(w, j, basis[a]);
#pragma GCC unroll 32
    for (int s = 0; s < End - Begin; ++s) {
      some[s] = some[s] + by_weight[table.first[Begin + s]] * basis[table.second[Begin + s]];
    }
  }
#pragma GCC unroll 32
  for (int s = 0; s < End - Begin; ++s) sums[Begin + s] = some[s];
}

/// The same for all sums from Begin on, in parts of about the same size.
template <int Dim, int Degree, int Begin = 0, class PackWeights>
[[gnu::always_inline]] inline void sum_moments_from(const Pack* z, PackWeights w, int n,
                                                    Pack* sums) {
  constexpr int left = MomentTable<Dim, Degree>::size - Begin;
  constexpr int most = sums_at_once<PackWeights>;
  constexpr int parts = (left + most - 1) / most;
  constexpr int end = Begin + (left + parts - 1) / parts;
  sum_some_moments<Dim, Degree, Begin, end>(z, w, n, sums);
  if constexpr (parts > 1) sum_moments_from<Dim, Degree, end>(z, w, n, sums);
}

/// The moment matrix sum_j w_j b_j b_j^T (lower triangle, row after row) of nodes 1 to n - 1, where
/// b holds the monomials and w is an array or EqualWeights.
template <int Dim, int Degree, class PackWeights>
[[gnu::always_inline]] inline void sum_moments(const Pack* z, PackWeights w, int n, Pack* moments) {
  using Table = MomentTable<Dim, Degree>;
  constexpr const Table& table = moment_table<Dim, Degree>;
  Pack sums[Table::size];
  sum_moments_from<Dim, Degree>(z, w, n, sums);
#pragma GCC unroll 256
  for (int entry = 0; entry < Table::terms * (Table::terms + 1) / 2; ++entry) {
    moments[entry] = sums[table.sum[entry]];
  }
}

}  // namespace strongpoint::STRONGPOINT_SIMD_PATH
