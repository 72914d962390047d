#include "methods/core/index_differences.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include <fmt/format.h>

#include "methods/core/error.hpp"
#include "methods/core/fornberg.hpp"
#include "methods/core/monomial.hpp"

namespace strongpoint {
namespace {

/// Weights on integers are rational with small denominators; anything below this is a zero.
constexpr double smallest_weight = 1e-13;
/// Roundings that an entry of B may carry: of each coordinate two, of each product as many.
constexpr double roundings = 4;

/// The difference of an order on `count` nodes from the index offset `first` on.
template <class Row>
Row make_row(int order, int first, int count) {
  std::vector<double> nodes(count);
  std::iota(nodes.begin(), nodes.end(), first);
  const Eigen::MatrixXd weights = fornberg_weights(nodes, 0, order);
  Row row{first, {}};
  for (int j = 0; j < count; ++j) {
    const double weight = weights(order, j);
    row.weights.push_back(std::abs(weight) < smallest_weight ? 0 : weight);
  }
  return row;
}

}  // namespace

template <int Dim>
IndexDifferences<Dim>::IndexDifferences(int order)
    : order_(order), terms_(Derivatives<Dim>::between_orders(1, std::max(2, order))) {
  if (order < 1 || order > 8) {
    throw UsageError(
        fmt::format("finite differences of order {} are not offered; allowed: 1 to 8", order));
  }
  for (const MultiIndex<Dim>& g : terms_) {
    std::array<int, Dim> lower{};
    for (int c = 0; c < Dim; ++c) {
      MultiIndex<Dim> less = g;
      --less[c];
      lower[c] = g[c] == 0 ? -2 : order_of<Dim>(less) == 0 ? -1 : terms_.index(less);
    }
    lower_.push_back(lower);
  }
  const int half = (order + 1) / 2;
  for (int k = 0; k <= terms_.highest_order(); ++k) {
    central_.push_back(k == 0 ? Row{0, {1}} : make_row<Row>(k, -half, 2 * half + 1));
    shifted_.emplace_back();
    const int count = k <= 1 ? order + 1 : order + 2;
    for (int before = 0; before < count; ++before) {
      shifted_[k].push_back(k == 0 ? Row{0, {1}} : make_row<Row>(k, -before, count));
    }
  }
}

template <int Dim>
int IndexDifferences<Dim>::needed_nodes() const {
  int nodes = 1;
  for (int c = 0; c < Dim; ++c) nodes *= width();
  return nodes;
}

template <int Dim>
int IndexDifferences<Dim>::system_size(int system) const {
  return order_ == 1 && system == 0 ? Dim : terms_.size();
}

template <int Dim>
const typename IndexDifferences<Dim>::Row* IndexDifferences<Dim>::row_for(int order, int low,
                                                                          int high) const {
  const int half = (order_ + 1) / 2;
  if (order == 0 || (low <= -half && high >= half)) return &central_[order];
  const int count = static_cast<int>(shifted_[order].size());
  if (high - low + 1 < count) return nullptr;
  return &shifted_[order][-std::clamp(-(count / 2), low, high - count + 1)];
}

template <int Dim>
bool IndexDifferences<Dim>::find_rows(const LocalStencil<Dim>& stencil, Workspace& work) const {
  if (stencil.block == nullptr) return false;
  const std::array<int, Dim>& shape = stencil.block->shape;
  const auto index_of = [&](int node) {
    std::array<int, Dim> index{};
    for (int c = Dim - 1; c > 0; --c) {
      index[c] = node % shape[c];
      node /= shape[c];
    }
    index[0] = node;  // beyond the shape for a node that is not of the block
    return index;
  };
  const std::array<int, Dim> centre = index_of(stencil.ids[stencil.centre]);
  std::array<int, Dim> low{};
  std::array<int, Dim> high{};
  work.offsets.clear();
  for (int node : stencil.ids) {
    const std::array<int, Dim> index = index_of(node);
    if (index[0] >= shape[0]) return false;
    for (int c = 0; c < Dim; ++c) {
      const int offset = index[c] - centre[c];
      work.offsets.push_back(offset);
      low[c] = std::min(low[c], offset);
      high[c] = std::max(high[c], offset);
    }
  }
  int filled = 1;
  work.rows.clear();
  for (int c = 0; c < Dim; ++c) filled *= high[c] - low[c] + 1;
  for (int k = 0; k <= terms_.highest_order(); ++k) {
    for (int c = 0; c < Dim; ++c) work.rows.push_back(row_for(k, low[c], high[c]));
  }
  return filled == stencil.size &&
         std::find(work.rows.begin(), work.rows.end(), nullptr) == work.rows.end();
}

template <int Dim>
void IndexDifferences<Dim>::fill_monomials(const Point<Dim>& z,
                                           std::vector<double>& monomials) const {
  monomials.resize(terms_.size());
  for (int g = 0; g < terms_.size(); ++g) {
    int c = 0;
    while (lower_[g][c] == -2) ++c;
    monomials[g] = (lower_[g][c] < 0 ? 1 : monomials[lower_[g][c]]) * z[c] / terms_[g][c];
  }
}

template <int Dim>
LocalOutcome IndexDifferences<Dim>::assemble(const LocalStencil<Dim>& stencil,
                                             Workspace& work) const {
  if (stencil.centre < 0) return LocalOutcome::no_centre;
  if (!find_rows(stencil, work)) return LocalOutcome::no_block;
  const int m = terms_.size();
  double sum = 0;
  int neighbours = 0;
  for (int j = 0; j < stencil.size; ++j) {
    int steps = 0;
    for (int c = 0; c < Dim; ++c) steps += std::abs(work.offsets[j * Dim + c]);
    if (steps == 1) sum += stencil.rho[j];
    if (steps == 1) ++neighbours;
  }
  work.length = sum / neighbours;
  work.functionals.resize(static_cast<std::size_t>(m) * stencil.size);
  work.matrix.assign(static_cast<std::size_t>(m) * m, 0.0);
  work.round_off.assign(static_cast<std::size_t>(m) * m, 0.0);
  for (int j = 0; j < stencil.size; ++j) {
    fill_monomials(stencil.node(j) / work.length, work.monomials);
    for (int a = 0; a < m; ++a) {
      double functional = 1;
      for (int c = 0; c < Dim; ++c) {
        functional *= work.rows[terms_[a][c] * Dim + c]->at(work.offsets[j * Dim + c]);
      }
      work.functionals[static_cast<std::size_t>(j) * m + a] = functional;
      if (functional == 0) continue;
      double* row = work.matrix.data() + static_cast<std::ptrdiff_t>(a) * m;
      double* noise = work.round_off.data() + static_cast<std::ptrdiff_t>(a) * m;
      for (int g = 0; g < m; ++g) {
        row[g] += functional * work.monomials[g];
        double moved = 0;  // by moving the node by one unit in every coordinate
        for (int lower : lower_[g]) {
          if (lower > -2) moved += lower < 0 ? 1 : std::abs(work.monomials[lower]);
        }
        noise[g] += std::abs(functional) *
                    (std::numeric_limits<double>::epsilon() * std::abs(work.monomials[g]) +
                     stencil.rounding / work.length * moved);
      }
    }
  }
  for (std::size_t i = 0; i < work.matrix.size(); ++i) {
    if (std::abs(work.matrix[i]) <= roundings * work.round_off[i]) work.matrix[i] = 0;
  }
  return LocalOutcome::ok;
}

template <int Dim>
LocalOutcome IndexDifferences<Dim>::factorise(const LocalStencil<Dim>& stencil,
                                              Workspace& work) const {
  const LocalOutcome outcome = assemble(stencil, work);
  if (outcome != LocalOutcome::ok) return outcome;
  for (int system = 0; system <= system_of(terms_.highest_order()); ++system) {
    const int size = system_size(system);
    double* matrix = work.systems[system].prepare(size);
    for (int a = 0; a < size; ++a) {
      const double* row = work.matrix.data() + static_cast<std::ptrdiff_t>(a) * terms_.size();
      matrix = std::copy(row, row + size, matrix);
    }
    if (!work.systems[system].factorise(rank_tolerance)) return LocalOutcome::singular;
  }
  return LocalOutcome::ok;
}

template <int Dim>
void IndexDifferences<Dim>::evaluate(const LocalStencil<Dim>& stencil, Workspace& work,
                                     const Point<Dim>& offset, const Derivatives<Dim>& derivatives,
                                     Eigen::Map<Eigen::MatrixXd> weights) const {
  const Point<Dim> at = offset / work.length;
  const Eigen::Map<const Eigen::MatrixXd> functionals(work.functionals.data(), terms_.size(),
                                                      stencil.size);
  for (int d = 0; d < derivatives.size(); ++d) {
    const int order = order_of<Dim>(derivatives[d]);
    const int system = system_of(order);
    const int size = system_size(system);
    work.solution.resize(size);
    for (int g = 0; g < size; ++g) {
      work.solution[g] =
          monomial_derivative<Dim>(terms_[g], derivatives[d], at) / factorial<Dim>(terms_[g]);
    }
    work.systems[system].solve_transposed(work.solution);
    weights.row(d).setZero();
    const double unit = std::pow(work.length, -order);
    for (int a = 0; a < size; ++a) {
      if (work.solution[a] != 0) weights.row(d) += unit * work.solution[a] * functionals.row(a);
    }
    if (order == 0) weights(d, stencil.centre) += 1;
  }
}

template <int Dim>
Eigen::MatrixXd IndexDifferences<Dim>::local_matrix(const LocalStencil<Dim>& stencil,
                                                    Scaling scaling) const {
  Workspace work;
  if (assemble(stencil, work) != LocalOutcome::ok) return Eigen::MatrixXd::Zero(1, 1);
  const int m = terms_.size();
  Eigen::MatrixXd matrix = Eigen::Map<const Eigen::MatrixXd>(work.matrix.data(), m, m).transpose();
  for (int g = 0; g < m && scaling == Scaling::row; ++g) {
    matrix.col(g) *= std::pow(stencil.radius * work.length, order_of<Dim>(terms_[g]));
  }
  return matrix;
}

template <int Dim>
std::string IndexDifferences<Dim>::unsupported(const Derivatives<Dim>& derivatives) const {
  for (const MultiIndex<Dim>& alpha : derivatives) {
    if (order_of<Dim>(alpha) > terms_.highest_order()) {
      return fmt::format("finite differences of order {} cannot give {}; ask for order={}", order_,
                         name_of<Dim>(alpha), order_of<Dim>(alpha));
    }
  }
  return {};
}

template class IndexDifferences<1>;
template class IndexDifferences<2>;
template class IndexDifferences<3>;

}  // namespace strongpoint
