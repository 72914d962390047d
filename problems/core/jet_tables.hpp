#pragma once

#include <array>
#include <cstdint>

#include "methods/core/derivatives.hpp"

namespace strongpoint {

/// Index tables of the monomials of total order <= Order in Dim variables, in graded order: by
/// order, then x before y before z, as `Derivatives::between_orders` lists them.
template <int Dim, int Order>
struct JetTables {
  static_assert(Dim >= 1 && Dim <= 3, "jets exist in one, two and three dimensions");
  static_assert(Order >= 0 && Order <= 8, "jets carry orders 0 to 8");

  /// Number of monomials, binomial(most + variables, variables).
  static constexpr int count(int most, int variables) {
    int result = 1;
    for (int i = 1; i <= variables; ++i) result = result * (most + i) / i;
    return result;
  }

  static constexpr int size = count(Order, Dim);
  static constexpr int product_count = count(Order, 2 * Dim);  ///< pairs whose product is kept

  std::array<MultiIndex<Dim>, size> exponents{};
  /// How many leading monomials j give a product with monomial i that is kept.
  std::array<std::uint8_t, size> partners{};
  /// Position of the product of monomials i and j, for i in order, then j < partners[i].
  std::array<std::uint8_t, product_count> products{};

  /// Position of a monomial of total order <= Order.
  static constexpr int position(const MultiIndex<Dim>& alpha) {
    int result = 0;
    int left = 0;
    for (int c = Dim - 1; c >= 0; --c) {
      left += alpha[c];
      result += left == 0 ? 0 : count(left - 1, Dim - c);
    }
    return result;
  }

  constexpr JetTables() {
    fill_exponents();
    int next = 0;
    for (int i = 0; i < size; ++i) {
      int order = 0;
      for (int a : exponents[i]) order += a;
      partners[i] = static_cast<std::uint8_t>(count(Order - order, Dim));
      for (int j = 0; j < partners[i]; ++j) {
        MultiIndex<Dim> sum = exponents[i];
        for (int c = 0; c < Dim; ++c) sum[c] += exponents[j][c];
        products[next++] = static_cast<std::uint8_t>(position(sum));
      }
    }
  }

 private:
  /// Visits every exponent triple of order <= Order and keeps those of the variables there are.
  constexpr void fill_exponents() {
    for (int a = 0; a <= Order; ++a) {
      for (int b = 0; a + b <= Order; ++b) {
        for (int c = 0; a + b + c <= Order; ++c) {
          if ((Dim < 2 && b > 0) || (Dim < 3 && c > 0)) continue;
          const std::array<int, 3> all{a, b, c};
          MultiIndex<Dim> alpha{};
          for (int k = 0; k < Dim; ++k) alpha[k] = all[k];
          exponents[position(alpha)] = alpha;
        }
      }
    }
  }
};

/// The tables of one kind of jet, made by the compiler.
template <int Dim, int Order>
inline constexpr JetTables<Dim, Order> jet_tables{};

}  // namespace strongpoint
