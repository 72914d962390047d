#pragma once

#include "methods/core/simd/pack.hpp"
#include "methods/core/simd/smoothing_profile.hpp"

namespace strongpoint::STRONGPOINT_SIMD_PATH {

/// Derivatives of orders 0 to 2 in Dim variables.
template <int Dim>
inline constexpr int up_to_second = (Dim + 1) * (Dim + 2) / 2;

/// exp(-s) for 0 <= s <= 10, to two units of the last place: s is brought to within log(2) / 2 of
/// zero, where the series of twelve powers is exact.
inline Pack exp_of_minus(Pack s) {
  constexpr double high = 0x1.62e42fefap-1;  // of log(2), so that differences are exact
  constexpr double low = 0x1.cf79abc9e3b3ap-40;
  constexpr int powers = 12;
  Pack power_of_two = all(1);
  for (int step = 8; step > 0; step /= 2) {
    const Pack near = all((step - 0.5) * high);
    power_of_two = choose_less(near, s, power_of_two * all(1.0 / (1 << step)), power_of_two);
    s = choose_less(near, s, (s - all(step * high)) - all(step * low), s);
  }
  Pack sum = all(1);
  for (int k = powers; k > 0; --k) sum = all(1) - s * sum * all(1.0 / k);
  return sum * power_of_two;
}

/// Fills f, f' and f'' by s, where f is a polynomial of q = sqrt(s): those of q^k are (k/2) q^(k-2)
/// and (k/2)(k/2 - 1) q^(k-4). `inverse` is 1 / q, or 1 at q = 0, where what it multiplies counts
/// only times powers of coordinates.
inline void evaluate_polynomial(const double* c, Pack q, Pack inverse, Pack* f) {
  f[0] = all(c[5]);
  for (int k = 4; k >= 0; --k) f[0] = f[0] * q + all(c[k]);
  f[1] = ((all(2.5 * c[5]) * q + all(2 * c[4])) * q + all(1.5 * c[3])) * q + all(c[2]) +
         all(0.5 * c[1]) * inverse;
  f[2] = all(3.75 * c[5]) * q + all(2 * c[4]) +
         (all(0.75 * c[3]) - all(0.25 * c[1]) * inverse * inverse) * inverse;
}

/// Fills the kernel and its first two derivatives by s, at s = q^2; zero outside the support.
inline void evaluate_profile(const SmoothingProfile& profile, Pack s, Pack* f) {
  const Pack q = sqrt(s);
  for (int m = 0; m < 3; ++m) f[m] = all(0);
  for (int p = profile.pieces - 1; p >= 0; --p) {
    const SmoothingProfile::Piece& piece = profile.piece[p];
    Pack here[3];
    if (piece.height > 0) {
      here[0] = all(piece.height) * exp_of_minus(min(s, all(piece.end * piece.end)));
      here[1] = all(0) - here[0];
      here[2] = here[0];
    } else {
      const Pack inverse = all(1) / choose_less(all(0), q, q, all(1));
      evaluate_polynomial(piece.coefficients, q, inverse, here);
    }
    for (int m = 0; m < 3; ++m) f[m] = choose_less(all(piece.end), q, f[m], here[m]);
  }
}

/// Fills all derivatives of orders 0 to 2 of f(|y|^2) at y, ordered as Derivatives::between_orders.
template <int Dim>
void differentiate_radial(const Pack* y, const Pack* f, Pack* values) {
  values[0] = f[0];
  for (int a = 0; a < Dim; ++a) values[1 + a] = all(2) * y[a] * f[1];
  Pack* next = values + 1 + Dim;
  for (int a = 0; a < Dim; ++a) {
    const Pack along = all(4) * y[a] * f[2];
    for (int b = a; b < Dim; ++b) {
      *next = along * y[b];
      if (a == b) *next = *next + all(2) * f[1];
      ++next;
    }
  }
}

/// h over R, given the local spacing over R.
inline Pack length_of(const SmoothingProfile& profile, Pack spacing) {
  const Pack nominal = all(profile.factor) * spacing;
  return choose_less(nominal * all(profile.enough), all(1), all(profile.stretched), nominal);
}

}  // namespace strongpoint::STRONGPOINT_SIMD_PATH
