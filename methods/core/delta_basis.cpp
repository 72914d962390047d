#include "methods/core/delta_basis.hpp"

#include <cmath>
#include <numbers>

#include <fmt/format.h>

namespace strongpoint {
namespace {

/// A box that is thinner than this, in units of the stencil radius, cannot be stretched.
constexpr double thinnest = 1e-10;
/// Smallest pivot over the largest entry that is more than round-off.
constexpr double pivot_tolerance = 1e-15;
constexpr double half_pi = std::numbers::pi / 2;

}  // namespace

template <int Dim>
DeltaBasis<Dim>::DeltaBasis(int sines, int regularity) {
  for (int n = 1; n <= sines; ++n) {
    const double ratio = static_cast<double>(n) / (sines + 1);
    lambda_.push_back(std::pow(1 - ratio * ratio, regularity));
  }
}

template <int Dim>
bool DeltaBasis<Dim>::prepare(const LocalStencil<Dim>& stencil, Workspace& work) const {
  const Eigen::Map<const Points<Dim>> nodes(stencil.z.data(), Dim, stencil.size);
  const Point<Dim> low = nodes.rowwise().minCoeff();
  const Point<Dim> high = nodes.rowwise().maxCoeff();
  work.middle = 0.5 * (low + high);
  work.size = high - low;
  if (work.size.minCoeff() < thinnest) return false;
  work.sines.resize(static_cast<std::size_t>(stencil.size) * Dim * sines());
  double* next = work.sines.data();
  for (int j = 0; j < stencil.size; ++j) {
    for (int c = 0; c < Dim; ++c) {
      const double s = (nodes(c, j) - work.middle[c]) / work.size[c];
      for (int n = 1; n <= sines(); ++n) {
        *next++ = std::sin(n * half_pi * (s + 1));
      }
    }
  }
  return true;
}

template <int Dim>
void DeltaBasis<Dim>::fill_matrix(const LocalStencil<Dim>& stencil, const Workspace& work,
                                  double* matrix) const {
  const auto sines_at = [&](int j, int c) {
    return work.sines.data() + (static_cast<std::ptrdiff_t>(j) * Dim + c) * sines();
  };
  for (int i = 0; i < stencil.size; ++i) {
    for (int j = 0; j <= i; ++j) {
      double product = 1;
      for (int c = 0; c < Dim; ++c) {
        double sum = 0;
        for (int n = 0; n < sines(); ++n) {
          sum += lambda_[n] * sines_at(i, c)[n] * sines_at(j, c)[n];
        }
        product *= sum;
      }
      matrix[static_cast<std::ptrdiff_t>(i) * stencil.size + j] = product;
      matrix[static_cast<std::ptrdiff_t>(j) * stencil.size + i] = product;
    }
  }
}

template <int Dim>
LocalOutcome DeltaBasis<Dim>::factorise(const LocalStencil<Dim>& stencil, Workspace& work) const {
  if (stencil.size < needed_nodes()) return LocalOutcome::too_small;
  if (!prepare(stencil, work)) return LocalOutcome::singular;
  fill_matrix(stencil, work, work.matrix.prepare(stencil.size));
  return work.matrix.factorise(pivot_tolerance) ? LocalOutcome::ok : LocalOutcome::flat;
}

template <int Dim>
void DeltaBasis<Dim>::evaluate(const LocalStencil<Dim>& stencil, Workspace& work,
                               const Point<Dim>& offset, const Derivatives<Dim>& derivatives,
                               Eigen::Map<Eigen::MatrixXd> weights) const {
  const int orders = derivatives.highest_order() + 1;
  const int n = stencil.size;
  // factor[(q Dim + c) n + j]: derivative of order q by coordinate c of the function at node j.
  work.factor.assign(static_cast<std::size_t>(orders) * Dim * n, 0.0);
  for (int q = 0; q < orders; ++q) {
    for (int c = 0; c < Dim; ++c) {
      const double t = (offset[c] - work.middle[c]) / work.size[c];
      double* row = work.factor.data() + static_cast<std::ptrdiff_t>(q * Dim + c) * n;
      for (int m = 1; m <= sines(); ++m) {
        const double sine = lambda_[m - 1] * std::pow(m * half_pi / work.size[c], q) *
                            std::sin(m * half_pi * (t + 1) + q * half_pi);
        const double* at_nodes =
            work.sines.data() + static_cast<std::ptrdiff_t>(c) * sines() + m - 1;
        for (int j = 0; j < n; ++j) {
          row[j] += sine * at_nodes[static_cast<std::ptrdiff_t>(j) * Dim * sines()];
        }
      }
    }
  }
  work.right_hand_side.resize(n);
  for (int d = 0; d < derivatives.size(); ++d) {
    for (int j = 0; j < n; ++j) {
      double product = 1;
      for (int c = 0; c < Dim; ++c) {
        product *= work.factor[static_cast<std::size_t>(derivatives[d][c] * Dim + c) * n + j];
      }
      work.right_hand_side[j] = product;
    }
    work.matrix.solve(work.right_hand_side);
    for (int j = 0; j < n; ++j) weights(d, j) = work.right_hand_side[j];
  }
}

template <int Dim>
Eigen::MatrixXd DeltaBasis<Dim>::local_matrix(const LocalStencil<Dim>& stencil,
                                              Scaling /*scaling*/) const {
  Workspace work;
  if (stencil.size < needed_nodes() || !prepare(stencil, work)) return Eigen::MatrixXd::Zero(1, 1);
  Eigen::MatrixXd matrix(stencil.size, stencil.size);
  fill_matrix(stencil, work, matrix.data());
  return matrix;
}

template <int Dim>
std::string DeltaBasis<Dim>::unsupported(const Derivatives<Dim>& derivatives) const {
  if (derivatives.highest_order() <= highest_order) return {};
  return fmt::format("derivatives of order above {} are not offered", highest_order);
}

template class DeltaBasis<1>;
template class DeltaBasis<2>;
template class DeltaBasis<3>;

}  // namespace strongpoint
