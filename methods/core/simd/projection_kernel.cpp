#include "methods/core/simd/projection_kernel.hpp"

#include "methods/core/simd/lane_gather.hpp"
#include "methods/core/simd/lane_lu.hpp"
#include "methods/core/simd/lane_numbers.hpp"
#include "methods/core/simd/lane_right_sides.hpp"
#include "methods/core/simd/lane_rows.hpp"
#include "methods/core/simd/lane_smoothing.hpp"

namespace strongpoint::STRONGPOINT_SIMD_PATH {
namespace {

/// A group of anchors on its way: weights of node j are y . P(z_j) with A^T y = right-hand side,
/// one solution for each derivative. Projections are kept with the other sign, as the product at
/// hand subtracts.
template <int Dim>
class ProjectionGroup {
 public:
  explicit ProjectionGroup(const ProjectionTask& task)
      : task_(task), n_(task.table.size), m_(task.monomials.terms), count_(task.derivatives.count) {
    LaneRoom room(task.scratch);
    stencils_.z = room.packs(static_cast<long>(n_) * Dim);
    stencils_.rho = room.packs(n_);
    projections_ = room.matrix(n_, m_);
    monomials_ = room.matrix(n_, m_);
    rows_ = room.matrix(n_, count_);
    matrix_ = room.matrix(m_, m_);
    lu_ = room.matrix(m_, m_);
    room_ = room.packs(static_cast<long>(m_) * (m_ + 1));
    right_sides_ = room.matrix(m_, count_);
    solutions_ = room.matrix(m_, count_);
    residuals_ = room.matrix(m_, count_);
    inverse_ = room.packs(m_);
    nodal_ = room.packs(m_);
  }

  unsigned run() {
    const StencilTable& table = task_.table;
    gather_squares<Dim>(table, 0, stencils_);
    unsigned good = lanes_in_use(table, 0) & ~stencils_.coincident;
    if (good == 0) return 0;
    per_radius_ = all(1) / stencils_.radius;
    project();
    fill_matrix();
    factorise_lu(m_, lu_, inverse_);
    good &= less(growth_condition(m_, lu_, inverse_, room_), all(task_.condition_limit));
    const LanePoints<Dim> points(table, task_.points, 0);
    unsigned failed = 0;
    for (long p = 0, most = points.most(good); p < most; ++p) {
      const unsigned some = good & points.with(p);
      solve(points, p);
      failed |= some & ~write_finite_rows(points, p, some, rows_.first, n_, count_);
    }
    return good & ~failed;
  }

 private:
  Pack per_radius_{};  ///< 1 / R
  LaneStencils stencils_{};
  const ProjectionTask& task_;
  LaneMatrix projections_;                          ///< (n, m) with the other sign
  LaneMatrix monomials_;                            ///< (n, m)
  LaneMatrix rows_;                                 ///< (n, D) weights
  LaneMatrix matrix_, lu_;                          ///< (m, m)
  LaneMatrix right_sides_, solutions_, residuals_;  ///< (m, D)
  Pack* room_;
  Pack* inverse_;
  Pack* nodal_;  ///< (m) sums of the projections that take the value from the first node
  int n_, m_, count_;

  /// Fills projections and monomials at the nodes.
  void project() {
    const int least = up_to_second<Dim> - m_;  // 1 without the kernel itself
    const Pack spacing = gather_of_anchors(task_.table, 0, task_.spacing) * per_radius_;
    const Pack per_length = all(1) / length_of(task_.profile, spacing);
    Pack unit = all(-1);
    for (int c = 0; c < Dim; ++c) unit = unit * per_radius_;
    Pack* const volumes = stencils_.rho;
    gather_of_nodes(task_.table, 0, task_.volumes, unit, volumes);
    // Packs may be anything to the compiler, members too.
    const SmoothingProfile profile = task_.profile;
    const MonomialList list = task_.monomials;
    const LaneMatrix projections = projections_;
    const LaneMatrix monomials = monomials_;
    const Pack* z = stencils_.z;
    const int m = m_;
    for (int j = 0, n = n_; j < n; ++j, z += Dim) {
      evaluate_list(list, z, &monomials(j, 0));
      Pack y[Dim];
      Pack square = all(0);
      for (int c = 0; c < Dim; ++c) {
        y[c] = z[c] * per_length;
        square = square + y[c] * y[c];
      }
      Pack f[3];
      Pack values[up_to_second<Dim>];
      evaluate_profile(profile, square, f);
      differentiate_radial<Dim>(y, f, values);
      for (int r = 0; r < m; ++r) projections(j, r) = volumes[j] * values[r + least];
    }
  }

  void fill_matrix() {
    for (int i = 0; i < m_; ++i) {
      for (int j = 0; j < m_; ++j) matrix_(i, j) = all(0);
    }
    subtract_product(m_, m_, matrix_, projections_.transposed(), monomials_, n_);
    for (int i = 0; i < m_; ++i) {
      Pack sum = all(0);
      for (int j = 0; task_.is_nodal[i] != 0 && j < n_; ++j) sum = sum - projections_(j, i);
      nodal_[i] = sum;
      for (int s = 0; s < m_; ++s) {
        const bool is_known = task_.is_nodal[i] != 0 && task_.monomials.axis[s] < 0;
        if (is_known || s >= task_.block_end[i]) matrix_(i, s) = all(0);
        lu_(i, s) = matrix_(i, s);
      }
    }
  }

  /// Fills the rows of the p-th points. A step of refinement makes up for the growth of the
  /// factors. Source: Skeel 1980.
  void solve(const LanePoints<Dim>& points, long p) {
    fill_right_sides<Dim>(points, p, per_radius_, task_.monomials, task_.derivatives, room_,
                          right_sides_);
    for (int r = 0; r < m_; ++r) {
      for (int d = 0; d < count_; ++d) solutions_(r, d) = residuals_(r, d) = right_sides_(r, d);
    }
    solve_transposed(m_, lu_, inverse_, count_, solutions_);
    subtract_product(m_, count_, residuals_, matrix_.transposed(), solutions_, m_);
    solve_transposed(m_, lu_, inverse_, count_, residuals_);
    for (int r = 0; r < m_; ++r) {
      for (int d = 0; d < count_; ++d) solutions_(r, d) = solutions_(r, d) + residuals_(r, d);
    }
    Pack* const rows = rows_.first;
    for (long e = 0, count = static_cast<long>(n_) * count_; e < count; ++e) rows[e] = all(0);
    subtract_product(n_, count_, rows_, projections_, solutions_, m_);
    add_nodal_values();
  }

  /// What the value at the first node, which is known, contributes.
  void add_nodal_values() {
    const bool has_value = task_.monomials.axis[0] < 0;
    for (int d = 0; d < count_; ++d) {
      if (task_.derivatives.order[d] == 0 && !has_value) rows_(0, d) = rows_(0, d) + all(1);
      for (int r = 0; r < m_; ++r) {
        if (task_.is_nodal[r] != 0) rows_(0, d) = rows_(0, d) - solutions_(r, d) * nodal_[r];
      }
    }
  }
};

}  // namespace

void project_taylor(const ProjectionTask& task) {
  switch (task.dim) {
    case 1:
      *task.done = ProjectionGroup<1>(task).run();
      return;
    case 2:
      *task.done = ProjectionGroup<2>(task).run();
      return;
    default:
      *task.done = ProjectionGroup<3>(task).run();
  }
}

}  // namespace strongpoint::STRONGPOINT_SIMD_PATH
