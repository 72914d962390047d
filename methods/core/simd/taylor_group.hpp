#pragma once

#include "methods/core/simd/lane_ldlt.hpp"
#include "methods/core/simd/lane_monomials.hpp"
#include "methods/core/simd/lane_points.hpp"
#include "methods/core/simd/lane_scatter.hpp"
#include "methods/core/simd/lane_weights.hpp"
#include "methods/core/simd/taylor_kernel.hpp"

namespace strongpoint::STRONGPOINT_SIMD_PATH {

/// The condition up to which eleven digits and more are left without refinement.
inline constexpr double largest_unrefined = 1e3;

/// The square of a bound of the condition below which it is not found; a little is left to
/// round-off.
inline constexpr double safe_square = largest_unrefined * largest_unrefined * (1 - 1e-9);

/// Derivatives whose weights are found together: their solutions share each node's monomials.
template <int Terms>
inline constexpr int derivatives_at_once = Terms <= 5 ? 5 : (Terms <= 9 ? 3 : 1);

/// One group of anchors on its way.
template <int Dim, int Order>
class TaylorGroup {
 public:
  static constexpr int terms = monomials_up_to<Dim>(Order);

  TaylorGroup(const TaylorTask& task, int first, Piece& waiting)
      : task_(task),
        table_(task.stencils.table),
        waiting_(waiting),
        points_(table_, task.points, first),
        size_(table_.size),
        count_(task.derivatives.count),
        first_(first) {
    LaneStencils stencils;
    w_ = gather_weighed<Dim>(task.stencils, first, stencils);
    z_ = stencils.z;
    radius_ = stencils.radius;
    faulty_ = stencils.coincident;
    rows_ = reinterpret_cast<Pack*>(task.scratch);
    piece_ = rows_ + static_cast<long>(size_) * count_;
    right_sides_ = piece_ + static_cast<long>(size_) * count_;
    solutions_ = right_sides_ + static_cast<long>(terms) * count_;
  }

  /// Bits of the lanes whose weights were written.
  unsigned run() {
    unsigned good = factorise() & ~faulty_;
    for (int lane = table_.count - first_; lane < lanes; ++lane) good &= ~(1U << lane);
    if (good == 0) return 0;
    scale_orders();
    const long most = points_.most(good);
    unsigned failed = 0;
    for (long p = 0; p < most; ++p) failed |= serve(p, good & points_.with(p));
    return good & ~failed;
  }

 private:
  static constexpr int highest_order = Order;

  InverseFactors<terms> inverse_;
  Pack order_factor_[highest_order + 1];  ///< R^-order
  Pack radius_;
  const TaylorTask& task_;
  const StencilTable& table_;
  Piece& waiting_;
  const LanePoints<Dim> points_;
  const Pack* z_;
  const Pack* w_;      ///< (n) T^2, 0 at the centre and in padding; null for ones
  Pack* rows_;         ///< (D, n) weights
  Pack* piece_;        ///< the same, lane after lane
  Pack* right_sides_;  ///< (terms, D)
  Pack* solutions_;    ///< (terms, D)
  int size_;
  int count_;  ///< D
  int first_;
  unsigned faulty_;        ///< lanes with coincident nodes
  unsigned delicate_ = 0;  ///< lanes whose solutions are refined

  /// Bits of the lanes whose moment matrices are well conditioned.
  unsigned factorise() {
    Pack moments[terms * (terms + 1) / 2];
    if (w_ == nullptr) {
      sum_moments<Dim, Order>(z_, EqualWeights{}, size_, moments);
    } else {
      sum_moments<Dim, Order>(z_, w_, size_, moments);
    }
    const Pack norm = norm_of_symmetric<terms>(moments);
    const unsigned good = factorise_ldlt<terms>(moments, task_.stencils.least_pivot);
    inverse_.take(moments);
    const unsigned safe = less(norm * norm * inverse_.square_bound(), all(safe_square));
    return (good & ~safe) == 0 ? good : good & judge(norm);
  }

  /// Finds the conditions, which nobody needs where a bound of them is small.
  [[gnu::noinline]] unsigned judge(Pack norm) {
    Pack inverse[terms * (terms + 1) / 2];
    inverse_.multiply(inverse);
    const Pack condition = norm * norm_of_symmetric<terms>(inverse);
    delicate_ = less(all(largest_unrefined), condition);
    return less(condition, all(task_.stencils.limit));
  }

  void scale_orders() {
    const Pack inverse = all(1) / radius_;
    order_factor_[0] = all(1);
    for (int q = 1; q <= highest_order; ++q) order_factor_[q] = order_factor_[q - 1] * inverse;
  }

  /// Fills right-hand sides and solutions for the p-th points.
  void solve(long p) {
    if (points_.are_anchors()) return solve_at_anchor();
    Pack at[Dim];
    points_.find(p, at);
    Pack farthest = all(0);
    for (int c = 0; c < Dim; ++c) {
      at[c] = at[c] * order_factor_[1];
      farthest = max(farthest, abs(at[c]));
    }
    if (less(all(0), farthest) == 0) return solve_at_anchor();
    Pack monomials[terms + 1];
    monomials[0] = all(1);
    evaluate_monomials<Dim, Order>(at, monomials + 1);
    for (int d = 0; d < count_; ++d) {
      const double* const factors = task_.derivatives.factors + static_cast<long>(d) * terms;
      const int* const powers = task_.derivatives.powers + static_cast<long>(d) * terms;
      const Pack scale = order_factor_[task_.derivatives.order[d]];
      Pack* const right_side = right_sides_ + static_cast<long>(d) * terms;
      for (int a = 0; a < terms; ++a) {
        right_side[a] =
            factors[a] == 0 ? all(0) : all(factors[a]) * monomials[powers[a] + 1] * scale;
      }
      inverse_.solve(right_side, solutions_ + static_cast<long>(d) * terms);
    }
  }

  /// The same where all but one of the terms of a derivative vanish.
  void solve_at_anchor() {
    for (int d = 0; d < count_; ++d) {
      Pack* const right_side = right_sides_ + static_cast<long>(d) * terms;
      Pack* const solution = solutions_ + static_cast<long>(d) * terms;
      const int own = task_.derivatives.own[d];
      for (int a = 0; a < terms; ++a) right_side[a] = all(0);
      for (int a = 0; own < 0 && a < terms; ++a) solution[a] = all(0);
      if (own < 0) continue;
      right_side[own] = all(task_.derivatives.factors[static_cast<long>(d) * terms + own]) *
                        order_factor_[task_.derivatives.order[d]];
      inverse_.solve_one(own, right_side[own], solution);
    }
  }

  Pack& weight(int d, int j) { return rows_[static_cast<long>(j) * count_ + d]; }
  Pack at_centre(int d) const { return task_.derivatives.order[d] == 0 ? all(1) : all(0); }

  /// Fills the rows of some derivatives from their solutions.
  template <int Count, class PackWeights>
  void weigh(int first, PackWeights w) {
    Pack solution[Count][terms];
    Pack centre[Count];
    for (int d = 0; d < Count; ++d) {
      centre[d] = at_centre(first + d);
      for (int a = 0; a < terms; ++a) {
        solution[d][a] = solutions_[static_cast<long>(first + d) * terms + a];
      }
    }
    // Packs may be anything to the compiler, members too.
    const Pack* z = z_;
    Pack* row = rows_ + first;
    const int size = size_;
    const long step = count_;
    for (int j = 1; j < size; ++j) {
      z += Dim;
      row += step;
      Pack basis[terms];
      evaluate_monomials<Dim, Order>(z, basis);
#pragma GCC unroll 8
      for (int d = 0; d < Count; ++d) {
        Pack sum = basis[0] * solution[d][0];
#pragma GCC unroll 64
        for (int a = 1; a < terms; ++a) sum = sum + basis[a] * solution[d][a];
        sum = weighted(w, j, sum);
        row[d] = sum;
        centre[d] = centre[d] - sum;
      }
    }
    for (int d = 0; d < Count; ++d) rows_[first + d] = centre[d];
  }

  /// The same for as many of them as are left.
  template <int Count = derivatives_at_once<terms>>
  void weigh_some(int first, int count) {
    if constexpr (Count > 1) {
      if (count < Count) return weigh_some<Count - 1>(first, count);
    }
    w_ == nullptr ? weigh<Count>(first, EqualWeights{}) : weigh<Count>(first, w_);
  }

  /// Corrects a row by what it leaves of the right-hand side; neither the rounding of the moment
  /// matrix nor that of the row counts any longer. Source: Bjorck 1987 (corrected seminormal
  /// equations).
  void refine(int d) {
    Pack residual[terms];
    Pack correction[terms];
    Pack basis[terms];
    for (int a = 0; a < terms; ++a) residual[a] = right_sides_[static_cast<long>(d) * terms + a];
    for (int j = 1; j < size_; ++j) {
      evaluate_monomials<Dim, Order>(z_ + static_cast<long>(j) * Dim, basis);
      for (int a = 0; a < terms; ++a) residual[a] = residual[a] - basis[a] * weight(d, j);
    }
    inverse_.solve(residual, correction);
    Pack centre = at_centre(d);
    for (int j = 1; j < size_; ++j) {
      evaluate_monomials<Dim, Order>(z_ + static_cast<long>(j) * Dim, basis);
      Pack sum = basis[0] * correction[0];
      for (int a = 1; a < terms; ++a) sum = sum + basis[a] * correction[a];
      if (w_ != nullptr) sum = sum * w_[j];
      weight(d, j) = weight(d, j) + choose(delicate_, sum, all(0));
      centre = centre - weight(d, j);
    }
    rows_[d] = centre;
  }

  /// Writes the weights of the p-th point of some lanes; returns the lanes in which they are not
  /// finite.
  unsigned serve(long p, unsigned served) {
    constexpr int most = derivatives_at_once<terms>;
    solve(p);
    for (int d = 0; d < count_; d += most) weigh_some(d, count_ - d < most ? count_ - d : most);
    for (int d = 0; delicate_ != 0 && d < count_; ++d) refine(d);
    Pack check = all(0);  // not a number if any weight is not finite
    for (int d = 0; d < count_; ++d) check = check + rows_[d] * all(0);
    const unsigned finite = less(check, all(1));
    write(p, served & finite);
    return served & ~finite;
  }

  void write(long p, unsigned served) {
    double* const piece = points_.piece(served, count_);
    if (piece != nullptr) return write_piece(piece, size_ * count_);
    LaneRows rows = points_.rows(p, served, count_);
    if (is_one_piece(rows.least, rows.entries, rows.to)) {
      return write_piece(rows.to[0], rows.least);
    }
    scatter_lanes(rows_, rows.least, rows.to, served);
    for (int lane = 0; lane < lanes; ++lane) {
      if (rows.entries[lane] <= rows.least) continue;
      rows.to[lane] += rows.least;
      scatter_lanes(rows_ + rows.least, rows.entries[lane] - rows.least, rows.to, 1U << lane);
    }
  }

  /// Writes rows of as many entries that lie one after the other.
  void write_piece(double* to, int entries) {
    const bool streamed = task_.output == Output::streamed;
    if (streamed) waiting_.write();
    double* const piece = streamed ? reinterpret_cast<double*>(piece_) : to;
    double* parts[lanes];
    for (int lane = 0; lane < lanes; ++lane)
      parts[lane] = piece + static_cast<long>(lane) * entries;
    if (!streamed) return scatter_lanes(rows_, entries, parts, every_lane);
    scatter_by_page(rows_, entries, parts);
    waiting_ = {piece, to, static_cast<long>(lanes) * entries};
  }
};

}  // namespace strongpoint::STRONGPOINT_SIMD_PATH
