#include "methods/core/mapped_differences.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>
#include <fmt/format.h>

#include "methods/core/error.hpp"
#include "methods/core/fornberg.hpp"

namespace strongpoint {
namespace {

/// Volume of the unit vectors along the coordinate lines below which these lie in a plane.
constexpr double flatness = 1e-12;

/// The derivative along one axis, or along two.
template <int Dim>
MultiIndex<Dim> along(int a, int b = -1) {
  MultiIndex<Dim> alpha{};
  ++alpha[a];
  if (b >= 0) ++alpha[b];
  return alpha;
}

}  // namespace

template <int Dim>
MappedDifferences<Dim>::MappedDifferences(int degree) : degree_(degree) {
  if (degree == whole_line || (degree >= 2 && degree <= most)) return;
  throw UsageError(
      fmt::format("differences of degree {} are not offered; allowed: 2 to {}, or "
                  "those of the whole line",
                  degree, most));
}

template <int Dim>
int MappedDifferences<Dim>::needed_nodes() const {
  int nodes = 1;
  for (int c = 0; c < Dim; ++c) nodes *= width();
  return nodes;
}

template <int Dim>
bool MappedDifferences<Dim>::find_lines(const LocalStencil<Dim>& stencil, Workspace& work) const {
  if (stencil.block == nullptr) return false;
  const IndexBlock<Dim>& block = *stencil.block;
  const auto index_along = [&](int node, int axis) {
    for (int c = Dim - 1; c > axis; --c) node /= block.shape[c];
    return axis == 0 ? node : node % block.shape[axis];
  };
  std::array<int, Dim> low{}, high{};
  work.offsets.clear();
  for (int node : stencil.ids) {
    for (int c = 0; c < Dim; ++c) {
      const int offset = index_along(node, c) - index_along(stencil.ids[stencil.centre], c);
      work.offsets.push_back(offset);
      low[c] = std::min(low[c], offset);
      high[c] = std::max(high[c], offset);
    }
  }
  int filled = 1;
  for (int c = 0; c < Dim; ++c) {
    filled *= high[c] - low[c] + 1;
    const int size = block.shape[c];
    const int count = degree_ == whole_line ? size : degree_ + 1;
    const int centre = index_along(stencil.ids[stencil.centre], c);
    const int first = std::clamp(centre - count / 2, 0, std::max(0, size - count));
    work.first[c] = first - centre;
    if (count < 3 || work.first[c] < low[c] || work.first[c] + count - 1 > high[c]) return false;
    work.axis.resize(count);
    for (int i = 0; i < count; ++i) {
      work.axis[i] = block.axes[c].empty() ? first + i : block.axes[c][first + i];
    }
    work.lines[c].resize(3, count);
    fornberg_weights(work.axis, work.axis[centre - first], work.lines[c]);
  }
  return filled == stencil.size;
}

template <int Dim>
double MappedDifferences<Dim>::difference(const Workspace& work, int node,
                                          const MultiIndex<Dim>& alpha) const {
  double product = 1;
  for (int c = 0; c < Dim; ++c) {
    const int offset = work.offsets[node * Dim + c];
    const int i = offset - work.first[c];
    if (alpha[c] == 0) {
      product *= offset == 0 ? 1 : 0;
    } else {
      product *= i >= 0 && i < work.lines[c].cols() ? work.lines[c](alpha[c], i) : 0;
    }
  }
  return product;
}

template <int Dim>
typename MappedDifferences<Dim>::Matrix MappedDifferences<Dim>::jacobian_of(
    const LocalStencil<Dim>& stencil, const Workspace& work) const {
  Matrix jacobian = Matrix::Zero();
  for (int j = 0; j < stencil.size; ++j) {
    for (int a = 0; a < Dim; ++a) {
      jacobian.col(a) += difference(work, j, along<Dim>(a)) * stencil.node(j);
    }
  }
  return jacobian;
}

template <int Dim>
LocalOutcome MappedDifferences<Dim>::factorise(const LocalStencil<Dim>& stencil,
                                               Workspace& work) const {
  if (stencil.centre < 0) return LocalOutcome::no_centre;
  if (!find_lines(stencil, work)) return LocalOutcome::no_block;
  const Matrix jacobian = jacobian_of(stencil, work);
  if (!(std::abs(jacobian.colwise().normalized().determinant()) > flatness)) {
    return LocalOutcome::singular;
  }
  const Matrix inverse = jacobian.inverse();
  std::array<Point<Dim>, Dim * Dim> bent;  // x_,ab
  for (int a = 0; a < Dim; ++a) {
    for (int b = 0; b < Dim; ++b) {
      bent[a * Dim + b].setZero();
      for (int j = 0; j < stencil.size; ++j) {
        bent[a * Dim + b] += difference(work, j, along<Dim>(a, b)) * stencil.node(j);
      }
    }
  }
  work.weights.resize(terms_.size(), stencil.size);
  for (int j = 0; j < stencil.size; ++j) {
    Point<Dim> slope;
    for (int a = 0; a < Dim; ++a) slope[a] = difference(work, j, along<Dim>(a));
    slope = inverse.transpose() * slope;
    Matrix second;
    for (int a = 0; a < Dim; ++a) {
      for (int b = 0; b < Dim; ++b) {
        second(a, b) = difference(work, j, along<Dim>(a, b)) - bent[a * Dim + b].dot(slope);
      }
    }
    second = inverse.transpose() * second * inverse;
    for (int a = 0; a < Dim; ++a) {
      work.weights(terms_.index(along<Dim>(a)), j) = slope[a];
      for (int b = a; b < Dim; ++b) {
        work.weights(terms_.index(along<Dim>(a, b)), j) = second(a, b);
      }
    }
  }
  return LocalOutcome::ok;
}

template <int Dim>
void MappedDifferences<Dim>::evaluate(const LocalStencil<Dim>& stencil, Workspace& work,
                                      const Point<Dim>& offset, const Derivatives<Dim>& derivatives,
                                      Eigen::Map<Eigen::MatrixXd> weights) const {
  const auto add = [&](int row, const MultiIndex<Dim>& alpha, double factor) {
    if (order_of<Dim>(alpha) > 2 || factor == 0) return;
    weights.row(row) += factor * work.weights.row(terms_.index(alpha));
  };
  weights.setZero();
  for (int d = 0; d < derivatives.size(); ++d) {
    const MultiIndex<Dim>& alpha = derivatives[d];
    if (order_of<Dim>(alpha) == 0) {
      weights(d, stencil.centre) += 1;
    } else {
      add(d, alpha, 1);
    }
    for (int a = 0; a < Dim; ++a) {
      MultiIndex<Dim> next = alpha;
      ++next[a];
      add(d, next, offset[a]);
      for (int b = 0; b < Dim && order_of<Dim>(alpha) == 0; ++b) {
        add(d, along<Dim>(a, b), offset[a] * offset[b] / 2);
      }
    }
  }
}

template <int Dim>
Eigen::MatrixXd MappedDifferences<Dim>::local_matrix(const LocalStencil<Dim>& stencil,
                                                     Scaling scaling) const {
  Workspace work;
  if (stencil.centre < 0 || !find_lines(stencil, work)) return Eigen::MatrixXd::Zero(1, 1);
  const Matrix jacobian = jacobian_of(stencil, work);
  return scaling == Scaling::both ? Matrix(jacobian.colwise().normalized()) : jacobian;
}

template <int Dim>
std::string MappedDifferences<Dim>::unsupported(const Derivatives<Dim>& derivatives) const {
  for (const MultiIndex<Dim>& alpha : derivatives) {
    if (order_of<Dim>(alpha) > 2) {
      return fmt::format("mapped differences cannot give {}; take exact=physical",
                         name_of<Dim>(alpha));
    }
  }
  return {};
}

template class MappedDifferences<1>;
template class MappedDifferences<2>;
template class MappedDifferences<3>;

}  // namespace strongpoint
