#pragma once

namespace strongpoint {

/// A smoothing kernel f(q), q = r / h, and the choice of h, as kernel sources read them.
struct SmoothingProfile {
  /// From one end to the next: sum_k coefficients[k] q^k, or height exp(-q^2).
  struct Piece {
    double end;
    double height;           ///< of a bell; 0 for a polynomial
    double coefficients[6];  ///< without a linear one in the piece that holds q = 0
  };
  static constexpr int most_pieces = 2;

  int pieces;
  Piece piece[most_pieces];
  double factor;     ///< h over the local spacing
  double enough;     ///< the support over h, with a tolerance: it is to reach R
  double stretched;  ///< h over R where it does not
};

}  // namespace strongpoint
