#pragma once

#include "methods/core/simd/lane_gather.hpp"
#include "methods/core/simd/lane_lu.hpp"
#include "methods/core/simd/lane_numbers.hpp"
#include "methods/core/simd/lane_right_sides.hpp"
#include "methods/core/simd/lane_rows.hpp"
#include "methods/core/simd/lane_smoothing.hpp"
#include "methods/core/simd/moving_kernel.hpp"

namespace strongpoint::STRONGPOINT_SIMD_PATH {

/// Smallest pivot over its diagonal entry: below it the condition is beyond every limit.
inline constexpr double least_moving_pivot = 1e-12;

/// A group of anchors on its way. Shape functions are phi_j = w_j f_j, f_j = p(z_j).r, A r = p(x),
/// A = sum_j w_j p(z_j) p(z_j)^T; their derivatives follow from Leibniz' rule, those of one order
/// at a time: A r^(alpha) = p^(alpha) - sum_j p(z_j) t_j, t_j = sum_(0<beta<=alpha) C(alpha, beta)
/// w_j^(beta) f_j^(alpha - beta). As the product at hand subtracts, -r is kept.
template <int Dim>
class MovingGroup {
 public:
  explicit MovingGroup(const MovingTask& task)
      : task_(task), n_(task.table.size), m_(task.monomials.terms), known_(task.known.count) {
    LaneRoom room(task.scratch);
    stencils_.z = room.packs(static_cast<long>(n_) * Dim);
    stencils_.rho = room.packs(n_);
    measures_ = room.packs(n_);
    basis_ = room.matrix(n_, m_);
    weighted_ = room.matrix(n_, m_);
    windows_ = room.matrix(n_, up_to_second<Dim>);
    products_ = room.matrix(n_, known_);
    functions_ = room.matrix(n_, known_);
    rows_ = room.matrix(n_, task.count);
    matrix_ = room.matrix(m_, m_);
    factors_ = room.matrix(m_, m_);
    inverted_ = room.matrix(m_, m_);
    right_sides_ = room.matrix(m_, known_);
    polynomials_ = room.matrix(m_, known_);
    inverse_ = room.packs(m_);
    roots_ = room.packs(m_);
    values_ = room.packs(m_);
  }

  unsigned run() {
    const StencilTable& table = task_.table;
    gather_squares<Dim>(table, 0, stencils_);
    unsigned good = lanes_in_use(table, 0) & ~stencils_.coincident;
    if (good == 0) return 0;
    per_radius_ = all(1) / stencils_.radius;
    prepare();
    const LanePoints<Dim> points(table, task_.points, 0);
    for (long p = 0, most = points.most(good); p < most && good != 0; ++p) {
      const unsigned some = good & points.with(p);
      unsigned served = some;
      if (p == 0 || task_.profile != nullptr) {
        fill_windows(points, p);
        served &= factorise();
      }
      find_functions(points, p);
      fill_rows();
      served &= write_finite_rows(points, p, served, rows_.first, n_, task_.count);
      good &= ~(some & ~served);
    }
    return good;
  }

 private:
  Pack per_radius_{};  ///< 1 / R
  Pack per_length_{};  ///< R / h
  LaneStencils stencils_{};
  const MovingTask& task_;
  LaneMatrix basis_;        ///< (n, m) p(z_j)
  LaneMatrix weighted_;     ///< (n, m) -w_j p(z_j)
  LaneMatrix windows_;      ///< (n, windows) w_j and its derivatives
  LaneMatrix products_;     ///< (n, known) t_j
  LaneMatrix functions_;    ///< (n, known) f_j
  LaneMatrix rows_;         ///< (n, D) weights
  LaneMatrix matrix_;       ///< (m, m) A
  LaneMatrix factors_;      ///< (m, m)
  LaneMatrix inverted_;     ///< (m, m) A^-1
  LaneMatrix right_sides_;  ///< (m, known) p^(alpha), less the sum
  LaneMatrix polynomials_;  ///< (m, known) -r^(alpha)
  Pack* measures_;          ///< (n) what windows are multiplied by; 0 in padding
  Pack* inverse_;           ///< (m) of the pivots
  Pack* roots_;             ///< (m) of the diagonal of A
  Pack* values_;            ///< (m) room
  int n_, m_, known_;

  /// What is the same at all points.
  void prepare() {
    if (task_.profile != nullptr) {
      const Pack spacing = gather_of_anchors(task_.table, 0, task_.spacing) * per_radius_;
      per_length_ = all(1) / length_of(*task_.profile, spacing);
    }
    Pack unit = all(1);
    for (int c = 0; c < Dim; ++c) unit = unit * per_radius_;
    // Packs may be anything to the compiler, members too.
    const LaneMatrix basis = basis_;
    const MonomialList list = task_.monomials;
    const Pack* z = stencils_.z;
    for (int j = 0, n = n_; j < n; ++j, z += Dim) evaluate_list(list, z, &basis(j, 0));
    if (task_.volumes != nullptr) {
      gather_of_nodes(task_.table, 0, task_.volumes, unit, measures_);
      return;
    }
    Pack* const measures = measures_;
    const Pack size = stencils_.size;
    for (int j = 0, n = n_; j < n; ++j) measures[j] = choose_less(all(j), size, all(1), all(0));
  }

  /// Fills the windows at the p-th points: derivatives of order q times R^-q.
  void fill_windows(const LanePoints<Dim>& points, long p) {
    if (task_.profile == nullptr) {
      return fill_fixed_window();
    }
    Pack at[Dim];
    points.find(p, at);
    for (int c = 0; c < Dim; ++c) at[c] = at[c] * per_radius_;
    const SmoothingProfile profile = *task_.profile;
    const Pack per_length = per_length_;
    const Pack unit = per_length * per_radius_;
    const Pack* const measures = measures_;
    const Pack* z = stencils_.z;
    Pack* to = windows_.first;
    for (int j = 0, n = n_; j < n; ++j, z += Dim, to += up_to_second<Dim>) {
      Pack y[Dim];
      Pack square = all(0);
      for (int c = 0; c < Dim; ++c) {
        y[c] = (at[c] - z[c]) * per_length;
        square = square + y[c] * y[c];
      }
      Pack f[3];
      Pack windows[up_to_second<Dim>];
      evaluate_profile(profile, square, f);
      differentiate_radial<Dim>(y, f, windows);
      // Round-off makes a spline negative at the edge of its support.
      to[0] = max(windows[0], all(0)) * measures[j];
      const Pack first = unit * measures[j];
      const Pack second = unit * first;
      for (int k = 1; k < up_to_second<Dim>; ++k) {
        to[k] = windows[k] * (k <= Dim ? first : second);
      }
    }
  }
  void fill_fixed_window() {
    const Pack* const squared = reinterpret_cast<const Pack*>(task_.squared);
    const Pack* const measures = measures_;
    const LaneMatrix windows = windows_;
    for (int j = 0, n = n_; j < n; ++j) {
      windows(j, 0) = squared == nullptr ? measures[j] : measures[j] * squared[j];
    }
  }

  static void clear(int rows, int columns, const LaneMatrix& matrix) {
    for (int i = 0; i < rows; ++i) {
      for (int j = 0; j < columns; ++j) matrix(i, j) = all(0);
    }
  }

  /// Bits of the lanes where A is well conditioned.
  unsigned factorise() {
    const LaneMatrix basis = basis_;
    const LaneMatrix weighted = weighted_;
    const LaneMatrix windows = windows_;
    const int m = m_;
    for (int j = 0, n = n_; j < n; ++j) {
      const Pack weight = all(0) - windows(j, 0);
      for (int a = 0; a < m; ++a) weighted(j, a) = weight * basis(j, a);
    }
    clear(m_, m_, matrix_);
    subtract_product_below(m_, matrix_, weighted_.transposed(), basis_, n_);
    for (int a = 0; a < m_; ++a) {
      roots_[a] = sqrt(matrix_(a, a));
      for (int b = 0; b <= a; ++b) factors_(a, b) = matrix_(a, b);
    }
    const unsigned good = factorise_definite(m_, factors_, inverse_, least_moving_pivot);
    return good & less(invert(), all(task_.condition_limit));
  }

  /// Inverts A and gives the condition in the 1-norm of A scaled to a unit diagonal.
  Pack invert() {
    for (int a = 0; a < m_; ++a) {
      for (int b = 0; b < m_; ++b) inverted_(a, b) = all(a == b ? 1 : 0);
    }
    solve_lu(m_, factors_, inverse_, m_, inverted_);
    Pack* const inverse_roots = values_;
    for (int a = 0; a < m_; ++a) inverse_roots[a] = all(1) / roots_[a];
    Pack largest = all(0);
    Pack largest_of_inverse = all(0);
    for (int a = 0; a < m_; ++a) {
      Pack sum = all(0);
      Pack sum_of_inverse = all(0);
      for (int b = 0; b < m_; ++b) {
        sum = sum + abs(b < a ? matrix_(a, b) : matrix_(b, a)) * inverse_roots[b];
        sum_of_inverse = sum_of_inverse + abs(inverted_(a, b)) * roots_[b];
      }
      largest = max(largest, sum * inverse_roots[a]);
      largest_of_inverse = max(largest_of_inverse, sum_of_inverse * roots_[a]);
    }
    return largest * largest_of_inverse;
  }

  /// Fills products and functions at the p-th points, one order after the other, or all at once
  /// where there are no products.
  void find_functions(const LanePoints<Dim>& points, long p) {
    const int* const order = task_.known.order;
    const int* const offsets = task_.product_offsets;
    fill_right_sides<Dim>(points, p, per_radius_, task_.monomials, task_.known, values_,
                          right_sides_);
    for (int begin = 0, end = 0; begin < known_; begin = end) {
      while (end < known_ && (order[end] == order[begin] || offsets[end + 1] == offsets[begin])) {
        ++end;
      }
      const int width = end - begin;
      const LaneMatrix right_sides = right_sides_.block(0, begin);
      const LaneMatrix polynomials = polynomials_.block(0, begin);
      const LaneMatrix functions = functions_.block(0, begin);
      multiply_windows(begin, end);
      if (offsets[end] > offsets[begin]) {
        subtract_product(m_, width, right_sides, basis_.transposed(), products_.block(0, begin),
                         n_);
      }
      clear(m_, width, polynomials);
      subtract_product(m_, width, polynomials, inverted_, right_sides, m_);
      clear(n_, width, functions);
      subtract_product(n_, width, functions, basis_, polynomials, m_);
    }
  }

  /// Fills the products of some derivatives.
  void multiply_windows(int begin, int end) {
    const int* const offsets = task_.product_offsets;
    const WindowProduct* const list = task_.products;
    const LaneMatrix windows = windows_;
    const LaneMatrix functions = functions_;
    const LaneMatrix products = products_;
    for (int k = begin; k < end; ++k) {
      const int first = offsets[k];
      const int last = offsets[k + 1];
      for (int j = 0, n = n_; j < n; ++j) {
        Pack sum = all(0);
        for (int i = first; i < last; ++i) {
          sum = sum +
                all(list[i].binomial) * windows(j, list[i].window) * functions(j, list[i].function);
        }
        products(j, k) = sum;
      }
    }
  }

  void fill_rows() {
    const LaneMatrix windows = windows_;
    const LaneMatrix functions = functions_;
    const LaneMatrix products = products_;
    const LaneMatrix rows = rows_;
    for (int d = 0, count = task_.count; d < count; ++d) {
      const int k = task_.asked[d];
      for (int j = 0, n = n_; j < n; ++j) {
        rows(j, d) = windows(j, 0) * functions(j, k) + products(j, k);
      }
    }
  }
};

}  // namespace strongpoint::STRONGPOINT_SIMD_PATH
