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

template <int Size, int Coarse>
using Plane = typename BlockAmg<Size, Coarse>::Plane;

/// From the finest level to the first coarse one.
template <int Size, int Coarse>
Transfer<Size, Coarse> first_transfer(const BlockMatrix<Size>& matrix, const Aggregates& aggregates,
                                      Plane<Size, Coarse>& plane) {
  if constexpr (Size == Coarse) {
    return constant_transfer(matrix, aggregates);
  } else {
    return rigid_transfer(aggregates, plane.bodies, plane.weights);
  }
}

/// From a coarse level to the next.
template <int Size, int Coarse>
Transfer<Coarse, Coarse> next_transfer(const BlockMatrix<Coarse>& matrix,
                                       const Aggregates& aggregates, Plane<Size, Coarse>& plane) {
  if constexpr (Size == Coarse) {
    return constant_transfer(matrix, aggregates);
  } else {
    return rigid_transfer(aggregates, plane.bodies);
  }
}

}  // namespace

template <int Size, int Coarse>
AmgLevel<Size, Coarse>::AmgLevel(const BlockMatrix<Size>& matrix, Transfer<Size, Coarse> transfer,
                                 SingleMatrix<Size, Coarse> fine_to_coarse,
                                 const std::vector<char>& filled)
    : smoother_(block_ilu0(matrix, filled)),
      transfer_(std::move(transfer)),
      fine_to_coarse_(std::move(fine_to_coarse)),
      residual_(static_cast<Eigen::Index>(matrix.rows()) * Size),
      coarse_r_(static_cast<Eigen::Index>(transfer_.aggregates.count) * Coarse),
      coarse_z_(coarse_r_.size()) {}

template <int Size, int Coarse>
Eigen::VectorXf& AmgLevel<Size, Coarse>::restrict_to_coarse(const Eigen::VectorXf& r) const {
  using Block = Eigen::Map<const Eigen::Matrix<float, Coarse, Size>>;
  const std::vector<int>& aggregates = transfer_.aggregates.of_node;
  coarse_r_.setZero();
  for (std::size_t row = 0; row < aggregates.size(); ++row) {
    if (aggregates[row] < 0) continue;
    float* sum = coarse_r_.data() + static_cast<std::ptrdiff_t>(aggregates[row]) * Coarse;
    Eigen::Map<Eigen::Matrix<float, Coarse, 1>>{sum} +=
        Block(transfer_.up.data() + row * Coarse * Size)
            .lazyProduct(Eigen::Map<const Eigen::Matrix<float, Size, 1>>(r.data() + row * Size));
  }
  return coarse_r_;
}

template <int Size, int Coarse>
void AmgLevel<Size, Coarse>::smooth(const Eigen::VectorXf& r, Eigen::VectorXf& z) const {
  using Block = Eigen::Map<const Eigen::Matrix<float, Size, Coarse>>;
  const std::vector<int>& aggregates = transfer_.aggregates.of_node;
  residual_ = r;
  subtract_product<Size, Coarse>(fine_to_coarse_.view(), smoother_.rows(), coarse_z_.data(),
                                 residual_.data());
  smoother_.apply(residual_, z);
  for (std::size_t row = 0; row < aggregates.size(); ++row) {
    if (aggregates[row] < 0) continue;
    const float* part = coarse_z_.data() + static_cast<std::ptrdiff_t>(aggregates[row]) * Coarse;
    Eigen::Map<Eigen::Matrix<float, Size, 1>>(z.data() + row * Size) +=
        Block(transfer_.down.data() + row * Size * Coarse)
            .lazyProduct(Eigen::Map<const Eigen::Matrix<float, Coarse, 1>>(part));
  }
}

template <int Size, int Coarse>
std::size_t AmgLevel<Size, Coarse>::bytes() const {
  return smoother_.bytes() + fine_to_coarse_.bytes() +
         transfer_.aggregates.of_node.size() * sizeof(int) +
         (transfer_.down.size() + transfer_.up.size() + residual_.size() + 2 * coarse_r_.size()) *
             sizeof(float);
}

template <int Size, int Coarse>
BlockAmg<Size, Coarse>::BlockAmg(const BlockMatrix<Size>& matrix, const Parameters& parameters,
                                 Plane plane)
    : Preconditioner(static_cast<Eigen::Index>(matrix.rows()) * Size), parameters_(parameters) {
  auto transfer =
      first_transfer<Size, Coarse>(matrix, aggregate(matrix, parameters_.strong), plane);
  CoarseLevel<Size, Coarse> first = coarsen(matrix, transfer);
  finest_.emplace(matrix, std::move(transfer), std::move(first.fine_to_coarse), plane.filled);
  BlockMatrix<Coarse> coarse = std::move(first.matrix);
  while (coarse.rows() > parameters_.coarsest_nodes) {
    // A level that hardly coarsens costs more than it gives.
    constexpr double most_share = 0.8;
    const Aggregates aggregates = aggregate(coarse, parameters_.strong);
    if (aggregates.count > most_share * coarse.rows()) break;
    auto way = next_transfer<Size, Coarse>(coarse, aggregates, plane);
    CoarseLevel<Coarse, Coarse> next = coarsen(coarse, way);
    const Eigen::Index unknowns = static_cast<Eigen::Index>(coarse.rows()) * Coarse;
    lower_.push_back({single(coarse),
                      {coarse, std::move(way), std::move(next.fine_to_coarse)},
                      Eigen::VectorXf(unknowns),
                      Eigen::VectorXf(unknowns)});
    coarse = std::move(next.matrix);
  }
  factorise(coarse);
}

template <int Size, int Coarse>
void BlockAmg<Size, Coarse>::factorise(const BlockMatrix<Coarse>& matrix) {
  const Eigen::Index unknowns = static_cast<Eigen::Index>(matrix.rows()) * Coarse;
  direct_r_.resize(unknowns);
  direct_z_.resize(unknowns);
  if (unknowns == 0) return;
  RowMatrix coarsest(unknowns, unknowns);
  coarsest.reserve(static_cast<Eigen::Index>(matrix.columns.size()) * Coarse * Coarse);
  for (Eigen::Index row = 0; row < unknowns; ++row) {
    coarsest.startVec(row);
    for (std::int64_t i = matrix.offsets[row / Coarse]; i < matrix.offsets[row / Coarse + 1]; ++i) {
      for (int j = 0; j < Coarse; ++j) {
        const Eigen::Index column = static_cast<Eigen::Index>(matrix.columns[i]) * Coarse + j;
        coarsest.insertBack(row, column) = matrix.values[(i * Coarse + j) * Coarse + row % Coarse];
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

template <int Size, int Coarse>
void BlockAmg<Size, Coarse>::apply(const Eigen::VectorXf& r, Eigen::VectorXf& z) const {
  cycle(*finest_, 0, r, z);
}

template <int Size, int Coarse>
template <class Level>
void BlockAmg<Size, Coarse>::cycle(const Level& level, std::size_t next, const Eigen::VectorXf& r,
                                   Eigen::VectorXf& z) const {
  solve_coarse(next, level.restrict_to_coarse(r), level.correction());
  level.correction() *= static_cast<float>(parameters_.enlarge);
  level.smooth(r, z);
}

/// Two cycles, the second on what the first left.
template <int Size, int Coarse>
void BlockAmg<Size, Coarse>::solve_coarse(std::size_t index, const Eigen::VectorXf& r,
                                          Eigen::VectorXf& z) const {
  if (index == lower_.size()) {
    if (!factors_) return;
    direct_r_ = r.cast<double>();
    factors_->solve(direct_r_.data(), direct_z_.data());
    z = direct_z_.cast<float>();
    return;
  }
  const Lower& lower = lower_[index];
  cycle(lower.level, index + 1, r, lower.first);
  lower.left = r;
  subtract_product<Coarse>(lower.matrix.view(), lower.matrix.rows(), lower.first.data(),
                           lower.left.data());
  cycle(lower.level, index + 1, lower.left, z);
  z += lower.first;
}

template <int Size, int Coarse>
int BlockAmg<Size, Coarse>::shifted_pivots() const {
  int shifted = finest_->shifted_pivots();
  for (const Lower& lower : lower_) shifted += lower.level.shifted_pivots();
  return shifted;
}

template <int Size, int Coarse>
std::size_t BlockAmg<Size, Coarse>::bytes() const {
  std::size_t sum = finest_->bytes() + (factors_ ? factors_->bytes() : 0);
  for (const Lower& lower : lower_) {
    sum += lower.matrix.bytes() + lower.level.bytes() + 2 * lower.first.size() * sizeof(float);
  }
  return sum;
}

template class AmgLevel<1, 1>;
template class AmgLevel<2, 2>;
template class AmgLevel<2, 3>;
template class AmgLevel<3, 3>;
template class AmgLevel<4, 4>;
template class BlockAmg<1>;
template class BlockAmg<2>;
template class BlockAmg<2, 3>;
template class BlockAmg<3>;
template class BlockAmg<4>;

}  // namespace strongpoint
