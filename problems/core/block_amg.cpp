#include "problems/core/block_amg.hpp"

#include <fmt/format.h>

#include "methods/core/error.hpp"
#include "problems/core/sparse_factor.hpp"

namespace strongpoint {
namespace {

template <int Size>
SingleMatrix<Size> single(const BlockMatrix<Size>& matrix) {
  SingleMatrix<Size> copy;
  copy.offsets = matrix.offsets;
  copy.columns = matrix.columns;
  copy.values.assign(matrix.values.begin(), matrix.values.end());
  return copy;
}

}  // namespace

template <int Size>
BlockAmg<Size>::BlockAmg(const BlockMatrix<Size>& matrix, const Parameters& parameters)
    : Preconditioner(static_cast<Eigen::Index>(matrix.rows()) * Size), parameters_(parameters) {
  BlockMatrix<Size> coarse;
  const BlockMatrix<Size>* finer = &matrix;
  while (levels_.empty() || finer->rows() > parameters_.coarsest_nodes) {
    // A level that hardly coarsens costs more than it gives.
    constexpr double most_share = 0.8;
    const Aggregates aggregates = aggregate(*finer, parameters_.strong);
    if (!levels_.empty() && aggregates.count > most_share * finer->rows()) break;
    coarse = add_level(*finer, aggregates);
    finer = &coarse;
  }
  factorise(*finer);
}

template <int Size>
BlockMatrix<Size> BlockAmg<Size>::add_level(const BlockMatrix<Size>& matrix,
                                            const Aggregates& aggregates) {
  const Eigen::Index unknowns = static_cast<Eigen::Index>(matrix.rows()) * Size;
  const Eigen::Index coarse_unknowns = static_cast<Eigen::Index>(aggregates.count) * Size;
  CoarseLevel<Size> coarse = coarsen(matrix, aggregates);
  const bool is_finest = levels_.empty();
  Level& level = levels_.emplace_back();
  level.smoother = block_ilu0(matrix);
  level.aggregates = aggregates.of_node;
  level.fine_to_coarse = std::move(coarse.fine_to_coarse);
  level.inverses = std::move(coarse.inverses);
  level.coarse_rows = aggregates.count;
  level.residual.resize(unknowns);
  level.coarse_r.resize(coarse_unknowns);
  level.coarse_z.resize(coarse_unknowns);
  if (!is_finest) {
    level.matrix = single(matrix);
    level.first.resize(unknowns);
    level.left.resize(unknowns);
  }
  return std::move(coarse.matrix);
}

template <int Size>
void BlockAmg<Size>::factorise(const BlockMatrix<Size>& matrix) {
  const Eigen::Index unknowns = static_cast<Eigen::Index>(matrix.rows()) * Size;
  direct_r_.resize(unknowns);
  direct_z_.resize(unknowns);
  if (unknowns == 0) return;
  RowMatrix coarsest(unknowns, unknowns);
  coarsest.reserve(static_cast<Eigen::Index>(matrix.columns.size()) * Size * Size);
  for (Eigen::Index row = 0; row < unknowns; ++row) {
    coarsest.startVec(row);
    for (std::int64_t i = matrix.offsets[row / Size]; i < matrix.offsets[row / Size + 1]; ++i) {
      for (int j = 0; j < Size; ++j) {
        const Eigen::Index column = static_cast<Eigen::Index>(matrix.columns[i]) * Size + j;
        coarsest.insertBack(row, column) = matrix.values[(i * Size + j) * Size + row % Size];
      }
    }
  }
  coarsest.finalize();
  const SparseFactor factor(
      Eigen::Map<const RowMatrix>(unknowns, unknowns, coarsest.nonZeros(), coarsest.outerIndexPtr(),
                                  coarsest.innerIndexPtr(), coarsest.valuePtr()));
  if (factor.fault() != SparseFactor::Fault::none) {
    throw CaseError(
        fmt::format("the coarsest matrix of {} unknowns is singular; take precond=ilut", unknowns));
  }
  factors_.emplace(factor.packed());
}

template <int Size>
void BlockAmg<Size>::apply(const Eigen::VectorXf& r, Eigen::VectorXf& z) const {
  cycle(0, r, z);
}

/// coarse_r = P^T D^-1 r.
template <int Size>
void BlockAmg<Size>::restrict_to_coarse(const Level& level, const Eigen::VectorXf& r) const {
  using Block = Eigen::Map<const Eigen::Matrix<float, Size, Size>>;
  using Part = Eigen::Matrix<float, Size, 1>;
  level.coarse_r.setZero();
  for (std::size_t row = 0; row < level.aggregates.size(); ++row) {
    if (level.aggregates[row] < 0) continue;
    const std::size_t first = row * Size;
    float* sum = level.coarse_r.data() + static_cast<std::ptrdiff_t>(level.aggregates[row]) * Size;
    Eigen::Map<Part>{sum} += Block(level.inverses.data() + first * Size)
                                 .lazyProduct(Eigen::Map<const Part>(r.data() + first));
  }
}

template <int Size>
void BlockAmg<Size>::cycle(std::size_t index, const Eigen::VectorXf& r, Eigen::VectorXf& z) const {
  const Level& level = levels_[index];
  restrict_to_coarse(level, r);
  solve_coarse(index + 1, level.coarse_r, level.coarse_z);
  level.coarse_z *= static_cast<float>(parameters_.enlarge);
  level.residual = r;
  subtract_product<Size>(level.fine_to_coarse.view(), level.smoother.rows(), level.coarse_z.data(),
                         level.residual.data());
  level.smoother.apply(level.residual, z);
  for (std::size_t row = 0; row < level.aggregates.size(); ++row) {
    if (level.aggregates[row] < 0) continue;
    const float* part =
        level.coarse_z.data() + static_cast<std::ptrdiff_t>(level.aggregates[row]) * Size;
    for (int i = 0; i < Size; ++i) z[static_cast<Eigen::Index>(row * Size) + i] += part[i];
  }
}

/// Two cycles, the second on what the first left.
template <int Size>
void BlockAmg<Size>::solve_coarse(std::size_t index, const Eigen::VectorXf& r,
                                  Eigen::VectorXf& z) const {
  if (index == levels_.size()) {
    if (!factors_) return;
    direct_r_ = r.cast<double>();
    factors_->solve(direct_r_.data(), direct_z_.data());
    z = direct_z_.cast<float>();
    return;
  }
  const Level& level = levels_[index];
  cycle(index, r, level.first);
  level.left = r;
  subtract_product<Size>(level.matrix.view(), level.matrix.rows(), level.first.data(),
                         level.left.data());
  cycle(index, level.left, z);
  z += level.first;
}

template <int Size>
int BlockAmg<Size>::shifted_pivots() const {
  int shifted = 0;
  for (const Level& level : levels_) shifted += level.smoother.shifted;
  return shifted;
}

template <int Size>
std::size_t BlockAmg<Size>::bytes() const {
  std::size_t sum = factors_ ? factors_->bytes() : 0;
  for (const Level& level : levels_) {
    sum += level.matrix.bytes() + level.smoother.bytes() + level.fine_to_coarse.bytes() +
           level.aggregates.size() * sizeof(int) + level.inverses.size() * sizeof(float) +
           (level.residual.size() + level.coarse_r.size() + level.coarse_z.size() +
            2 * level.first.size()) *
               sizeof(float);
  }
  return sum;
}

template class BlockAmg<1>;
template class BlockAmg<2>;
template class BlockAmg<3>;
template class BlockAmg<4>;

}  // namespace strongpoint
