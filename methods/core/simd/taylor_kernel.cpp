#include "methods/core/simd/taylor_kernel.hpp"

#include "methods/core/simd/lane_gather.hpp"
#include "methods/core/simd/lane_ldlt.hpp"
#include "methods/core/simd/lane_monomials.hpp"
#include "methods/core/simd/lane_scatter.hpp"
#include "methods/core/simd/lane_weights.hpp"

namespace strongpoint::STRONGPOINT_SIMD_PATH {
namespace {

/// The condition up to which eleven digits and more are left without refinement.
constexpr double largest_unrefined = 1e3;

/// One group of anchors on its way.
template <int Dim, int Order>
class Group {
 public:
  static constexpr int terms = monomials_up_to<Dim>(Order);

  Group(const TaylorTask& task, int first)
      : task_(task), table_(task.gathered.table), size_(table_.size), first_(first) {
    const long place = first / lanes;
    z_ = reinterpret_cast<const Pack*>(task.gathered.z) + place * size_ * Dim;
    squared_ = reinterpret_cast<const Pack*>(task.squared) + place * size_;
    radius_ = load(task.gathered.radius + first);
    weighted_ = reinterpret_cast<Pack*>(task.scratch);
    rows_ = weighted_ + static_cast<long>(size_) * terms;
  }

  /// Bits of the lanes whose weights were written.
  unsigned run() {
    unsigned good = factorise() & ~task_.gathered.faulty[first_ / lanes];
    for (int lane = table_.count - first_; lane < lanes; ++lane) good &= ~(1U << lane);
    if (good == 0) return 0;
    scale_orders();
    long most = 0;
    for (int lane = 0; lane < lanes; ++lane) {
      if ((good >> lane & 1U) != 0) most = points_of(lane) > most ? points_of(lane) : most;
    }
    unsigned failed = 0;
    for (long p = 0; p < most; ++p) {
      unsigned served = good;
      for (int lane = 0; lane < lanes; ++lane) {
        if (points_of(lane) <= p) served &= ~(1U << lane);
      }
      failed |= serve(p, served);
    }
    return good & ~failed;
  }

 private:
  static constexpr int highest_order = Order;

  Pack inverse_[terms * (terms + 1) / 2];
  Pack order_factor_[highest_order + 1];  ///< R^-order
  Pack radius_;
  const TaylorTask& task_;
  const StencilTable& table_;
  const Pack* z_;
  const Pack* squared_;
  Pack* weighted_;  ///< (terms, n) T^2 times the monomials
  Pack* rows_;      ///< (D, n) weights
  int size_;
  int first_;
  unsigned delicate_ = 0;  ///< lanes whose solutions are refined

  int anchor(int lane) const {
    return table_.chosen[first_ + lane < table_.count ? first_ + lane : table_.count - 1];
  }
  long points_of(int lane) const {
    const std::int64_t* const offsets = task_.points.offsets + anchor(lane);
    return offsets[1] - offsets[0];
  }

  /// Bits of the lanes whose moment matrices are well conditioned.
  unsigned factorise() {
    Pack* const weights = rows_;  // free until the solutions are known
    mask_weights(table_, first_, squared_, weights);
    Pack moments[terms * (terms + 1) / 2];
    sum_moments<Dim, Order>(z_, weights, size_, weighted_, moments);
    const Pack norm = norm_of_symmetric<terms>(moments);
    const unsigned good = factorise_ldlt<terms>(moments, task_.least_pivot);
    invert_ldlt<terms>(moments, inverse_);
    const Pack condition = norm * norm_of_symmetric<terms>(inverse_);
    delicate_ = less(all(largest_unrefined), condition);
    return good & less(condition, all(task_.condition_limit));
  }

  void scale_orders() {
    const Pack inverse = all(1) / radius_;
    order_factor_[0] = all(1);
    for (int q = 1; q <= highest_order; ++q) order_factor_[q] = order_factor_[q - 1] * inverse;
  }

  Pack inverse_entry(int i, int j) const {
    return inverse_[i > j ? triangle(i, j) : triangle(j, i)];
  }

  /// The monomials, the constant first, at the p-th point of each lane, relative to the anchor and
  /// over R. Lanes without one get their last.
  void evaluate_at(long p, Pack* monomials) const {
    const double* place[lanes];
    const double* origin[lanes];
    for (int lane = 0; lane < lanes; ++lane) {
      const int a = anchor(lane);
      const long count = points_of(lane);
      const std::int64_t list = task_.points.offsets[a];
      origin[lane] = table_.anchors + static_cast<long>(a) * Dim;
      place[lane] =
          count == 0
              ? origin[lane]
              : task_.points.points +
                    static_cast<long>(task_.points.ids[list + (p < count ? p : count - 1)]) * Dim;
    }
    Pack from[Dim];
    Pack at[Dim];
    load_nodes<Dim>(place, at);
    load_nodes<Dim>(origin, from);
    for (int c = 0; c < Dim; ++c) at[c] = (at[c] - from[c]) * order_factor_[1];
    monomials[0] = all(1);
    evaluate_monomials<Dim, Order>(at, monomials + 1);
  }

  /// A derivative of all monomials.
  void differentiate(int d, const Pack* monomials, Pack* result) const {
    const double* const factors = task_.derivatives.factors + static_cast<long>(d) * terms;
    const int* const powers = task_.derivatives.powers + static_cast<long>(d) * terms;
    for (int a = 0; a < terms; ++a) {
      result[a] = factors[a] == 0 ? all(0) : all(factors[a]) * monomials[powers[a] + 1];
    }
  }

  /// The inverse times a right-hand side, most of which is zero at an anchor.
  void by_inverse(const Pack* right_side, Pack* solution) const {
    for (int i = 0; i < terms; ++i) solution[i] = all(0);
    for (int a = 0; a < terms; ++a) {
      if (less(all(0), abs(right_side[a])) == 0) continue;
      for (int i = 0; i < terms; ++i) {
        solution[i] = solution[i] + inverse_entry(i, a) * right_side[a];
      }
    }
  }

  /// T^2 times the Taylor terms of node j, combined.
  [[gnu::always_inline]] Pack combine(int j, const Pack* solution) const {
    const Pack* const row = weighted_ + static_cast<long>(j) * terms;
    Pack weight = row[0] * solution[0];
#pragma GCC unroll 64
    for (int a = 1; a < terms; ++a) weight = weight + row[a] * solution[a];
    return weight;
  }

  Pack& weight(int d, int j) { return rows_[static_cast<long>(j) * task_.derivatives.count + d]; }

  /// Fills a derivative's row of weights from its solution.
  void weigh(int d, const Pack* solution) {
    Pack z[terms];
#pragma GCC unroll 64
    for (int a = 0; a < terms; ++a) z[a] = solution[a];
    Pack centre = task_.derivatives.order[d] == 0 ? all(1) : all(0);
    for (int j = 1; j < size_; ++j) {
      const Pack found = combine(j, z);
      weight(d, j) = found;
      centre = centre - found;
    }
    rows_[d] = centre;
  }

  /// Corrects a row by what it leaves of the right-hand side; neither the rounding of the moment
  /// matrix nor that of the row counts any longer. Source: Bjorck 1987 (corrected seminormal
  /// equations).
  void refine(int d, const Pack* right_side) {
    Pack residual[terms];
    Pack correction[terms];
    for (int a = 0; a < terms; ++a) residual[a] = right_side[a];
    for (int j = 1; j < size_; ++j) {
      Pack basis[terms];
      evaluate_monomials<Dim, Order>(z_ + static_cast<long>(j) * Dim, basis);
      for (int a = 0; a < terms; ++a) residual[a] = residual[a] - basis[a] * weight(d, j);
    }
    by_inverse(residual, correction);
    Pack centre = task_.derivatives.order[d] == 0 ? all(1) : all(0);
    for (int j = 1; j < size_; ++j) {
      weight(d, j) = weight(d, j) + choose(delicate_, combine(j, correction), all(0));
      centre = centre - weight(d, j);
    }
    rows_[d] = centre;
  }

  /// Writes the weights of the p-th point of some lanes; returns the lanes in which they are not
  /// finite.
  unsigned serve(long p, unsigned served) {
    Pack monomials[terms + 1];
    evaluate_at(p, monomials);
    Pack check = all(0);
    for (int d = 0; d < task_.derivatives.count; ++d) {
      Pack right_side[terms];
      Pack solution[terms];
      differentiate(d, monomials, right_side);
      const Pack scale = order_factor_[task_.derivatives.order[d]];
      for (int i = 0; i < terms; ++i) right_side[i] = right_side[i] * scale;
      by_inverse(right_side, solution);
      weigh(d, solution);
      if (delicate_ != 0) refine(d, right_side);
      check = check + rows_[d] * all(0);  // not a number if any weight is not finite
    }
    const unsigned finite = less(check, all(1));
    write(p, served & finite);
    return served & ~finite;
  }

  void write(long p, unsigned served) {
    const int count = task_.derivatives.count;
    double* to[lanes] = {};
    int entries[lanes] = {};
    int least = size_ * count;  // entries that all rows have
    for (int lane = 0; lane < lanes; ++lane) {
      if ((served >> lane & 1U) == 0) continue;
      const int point = task_.points.ids[task_.points.offsets[anchor(lane)] + p];
      const std::int64_t* const rows = task_.points.rows + point;
      to[lane] = task_.points.values + rows[0] * count;
      entries[lane] = static_cast<int>(rows[1] - rows[0]) * count;
      least = entries[lane] < least ? entries[lane] : least;
    }
    scatter_lanes(rows_, least, to, served);
    for (int lane = 0; lane < lanes; ++lane) {
      if (entries[lane] <= least) continue;
      to[lane] += least;
      scatter_lanes(rows_ + least, entries[lane] - least, to, 1U << lane);
    }
  }
};

template <int Dim, int Order>
void fit(const TaylorTask& task) {
  for (int first = 0; first < task.gathered.table.count; first += lanes) {
    task.done[first / lanes] = Group<Dim, Order>(task, first).run();
  }
}

template <int Dim>
void fit_any_order(const TaylorTask& task) {
  switch (task.order) {
    case 1:
      return fit<Dim, 1>(task);
    case 2:
      return fit<Dim, 2>(task);
    case 3:
      return fit<Dim, 3>(task);
    default:
      if constexpr (Dim < 3) fit<Dim, 4>(task);
  }
}

}  // namespace

void fit_taylor(const TaylorTask& task) {
  switch (task.gathered.dim) {
    case 1:
      return fit_any_order<1>(task);
    case 2:
      return fit_any_order<2>(task);
    default:
      return fit_any_order<3>(task);
  }
}

}  // namespace strongpoint::STRONGPOINT_SIMD_PATH
