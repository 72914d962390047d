#include "methods/core/projection_fit.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "methods/core/monomial.hpp"

namespace strongpoint {

template <int Dim>
ProjectionFit<Dim>::ProjectionFit(const std::vector<Derivatives<Dim>>& blocks,
                                  Projections<Dim> projections,
                                  std::optional<SmoothingProfile> profile)
    : projections_(std::move(projections)), profile_(profile) {
  for (const Derivatives<Dim>& block : blocks) {
    const bool is_nodal = !block.contains({});
    needs_centre_ = needs_centre_ || is_nodal;
    terms_.merge(block);
    block_end_.resize(terms_.size(), terms_.size());
    is_nodal_.resize(terms_.size(), is_nodal ? 1 : 0);
  }
}

template <int Dim>
int ProjectionFit<Dim>::needed_nodes() const {
  int largest = 0;
  for (int begin = 0; begin < terms(); begin = block_end_[begin]) {
    largest = std::max(largest, block_end_[begin] - begin + is_nodal_[begin]);
  }
  return largest;
}

template <int Dim>
void ProjectionFit<Dim>::project(const LocalStencil<Dim>& stencil, Workspace& work) const {
  const int m = terms();
  work.projections.resize(static_cast<std::size_t>(m) * stencil.size);
  projections_(stencil, work.projections.data());
  work.powers.resize(m);
  work.moments.assign(static_cast<std::size_t>(m) * m, 0.0);
  work.nodal.assign(m, 0.0);
  for (int j = 0; j < stencil.size; ++j) {
    const Point<Dim> z = stencil.node(j);
    for (int s = 0; s < m; ++s) work.powers[s] = monomial_derivative<Dim>(terms_[s], {}, z);
    for (int r = 0; r < m; ++r) {
      const double projection = work.projections[static_cast<std::size_t>(j) * m + r];
      double* row = work.moments.data() + static_cast<std::ptrdiff_t>(r) * m;
      for (int s = 0; s < block_end_[r]; ++s) {
        const bool is_known_value = is_nodal_[r] != 0 && order_of<Dim>(terms_[s]) == 0;
        if (!is_known_value) row[s] += projection * work.powers[s];
      }
      if (is_nodal_[r] != 0) work.nodal[r] += projection;
    }
  }
}

template <int Dim>
LocalOutcome ProjectionFit<Dim>::factorise(const LocalStencil<Dim>& stencil,
                                           Workspace& work) const {
  const int m = terms();
  if (needs_centre_ && stencil.centre < 0) return LocalOutcome::no_centre;
  if (stencil.size < needed_nodes()) return LocalOutcome::too_small;
  project(stencil, work);
  work.coefficients.assign(work.projections.begin(), work.projections.end());
  for (int begin = 0; begin < m; begin = block_end_[begin]) {
    const int end = block_end_[begin];
    double* matrix = work.lu.prepare(end - begin);
    for (int r = begin; r < end; ++r) {
      const double* row = work.moments.data() + static_cast<std::ptrdiff_t>(r) * m;
      matrix = std::copy(row + begin, row + end, matrix);
    }
    if (!work.lu.factorise(rank_tolerance)) return LocalOutcome::singular;
    for (int j = 0; j < stencil.size; ++j) {
      double* c = work.coefficients.data() + static_cast<std::ptrdiff_t>(j) * m;
      for (int r = begin; r < end; ++r) {
        if (j == stencil.centre) c[r] -= work.nodal[r];
        for (int s = 0; s < begin; ++s) {
          c[r] -= work.moments[static_cast<std::size_t>(r) * m + s] * c[s];
        }
      }
      work.lu.solve({c + begin, c + end});
    }
  }
  return LocalOutcome::ok;
}

template <int Dim>
void ProjectionFit<Dim>::evaluate(const LocalStencil<Dim>& stencil, Workspace& work,
                                  const Point<Dim>& offset, const Derivatives<Dim>& derivatives,
                                  Eigen::Map<Eigen::MatrixXd> weights) const {
  const int m = terms();
  const Eigen::Map<const Eigen::MatrixXd> coefficients(work.coefficients.data(), m, stencil.size);
  const bool has_value = terms_.contains({});
  for (int d = 0; d < derivatives.size(); ++d) {
    weights.row(d).setZero();
    for (int s = 0; s < m; ++s) {
      const double factor = monomial_derivative<Dim>(terms_[s], derivatives[d], offset);
      if (factor != 0) weights.row(d) += factor * coefficients.row(s);
    }
    if (order_of<Dim>(derivatives[d]) == 0 && !has_value) weights(d, stencil.centre) += 1;
  }
}

template <int Dim>
void ProjectionFit<Dim>::fill_batch(const StencilBatch<Dim>& batch, Workspace& work,
                                    Weights& weights, std::span<LocalOutcome> outcomes) const {
  if (!profile_) return;
  work.batch.fill({terms_, block_end_, is_nodal_, needed_nodes(), needs_centre_, *profile_}, batch,
                  weights, outcomes);
}

template <int Dim>
Eigen::MatrixXd ProjectionFit<Dim>::local_matrix(const LocalStencil<Dim>& stencil,
                                                 Scaling scaling) const {
  const int m = terms();
  const bool lacks_centre = needs_centre_ && stencil.centre < 0;
  if (lacks_centre || stencil.size < needed_nodes()) return Eigen::MatrixXd::Zero(1, 1);
  Workspace work;
  project(stencil, work);
  Eigen::MatrixXd matrix = Eigen::Map<const Eigen::MatrixXd>(work.moments.data(), m, m).transpose();
  for (int s = 0; s < m; ++s) {
    double column = 1 / factorial<Dim>(terms_[s]);
    if (scaling == Scaling::row) column *= std::pow(stencil.radius, order_of<Dim>(terms_[s]));
    matrix.col(s) *= column;
  }
  return matrix;
}

template <int Dim>
std::string ProjectionFit<Dim>::unsupported(const Derivatives<Dim>& derivatives) const {
  for (const MultiIndex<Dim>& alpha : derivatives) {
    if (order_of<Dim>(alpha) > 0 && !terms_.contains(alpha)) {
      return fmt::format("the Taylor series is cut after order {}: it cannot give {}",
                         terms_.highest_order(), name_of<Dim>(alpha));
    }
  }
  return {};
}

template class ProjectionFit<1>;
template class ProjectionFit<2>;
template class ProjectionFit<3>;

}  // namespace strongpoint
