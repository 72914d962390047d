#include "problems/core/transfer.hpp"

#include <algorithm>
#include <cmath>

namespace strongpoint {
namespace {

template <int Rows, int Columns = Rows>
using Block = Eigen::Matrix<double, Rows, Columns>;

template <int Size>
Eigen::Map<const Block<Size>> block_at(const BlockMatrix<Size>& matrix, std::int64_t place) {
  return Eigen::Map<const Block<Size>>(matrix.values.data() + place * Size * Size);
}

/// Block `node` of a transfer in double precision.
template <int Rows, int Columns>
Block<Rows, Columns> widened(const std::vector<float>& blocks, int node) {
  return Eigen::Map<const Eigen::Matrix<float, Rows, Columns>>(
             blocks.data() + static_cast<std::ptrdiff_t>(node) * Rows * Columns)
      .template cast<double>();
}

template <class Matrix>
void append(std::vector<float>& blocks, const Matrix& block) {
  blocks.insert(blocks.end(), block.data(), block.data() + block.size());
}

/// The nodes of each aggregate, in compressed rows.
struct Members {
  std::vector<int> offsets, nodes;

  explicit Members(const Aggregates& aggregates) : offsets(aggregates.count + 1, 0) {
    for (const int aggregate : aggregates.of_node) {
      if (aggregate >= 0) ++offsets[aggregate + 1];
    }
    for (int i = 0; i < aggregates.count; ++i) offsets[i + 1] += offsets[i];
    nodes.resize(offsets.back());
    std::vector<int> next(offsets.begin(), offsets.end() - 1);
    for (std::size_t node = 0; node < aggregates.of_node.size(); ++node) {
      const int aggregate = aggregates.of_node[node];
      if (aggregate >= 0) nodes[next[aggregate]++] = static_cast<int>(node);
    }
  }
};

/// Sums blocks by column for one row after the other.
template <int Rows, int Columns>
class RowSum {
 public:
  explicit RowSum(int columns) : places_(columns, -1) {}

  template <class Product>
  void add(int column, const Product& block) {
    int& place = places_[column];
    if (place < 0) {
      place = static_cast<int>(columns_.size());
      columns_.push_back(column);
      blocks_.push_back(Block<Rows, Columns>::Zero());
    }
    blocks_[place] += block;
  }
  /// Hands each block to `take(column, block)` in the order of columns, and forgets the row.
  template <class Take>
  void drain(const Take& take) {
    std::sort(columns_.begin(), columns_.end());
    for (const int column : columns_) {
      take(column, blocks_[places_[column]]);
      places_[column] = -1;
    }
    columns_.clear();
    blocks_.clear();
  }

 private:
  std::vector<int> places_, columns_;
  std::vector<Block<Rows, Columns>> blocks_;
};

/// The inverse of a row's diagonal block, or the unit block.
template <int Size>
Eigen::Matrix<float, Size, Size> inverse_diagonal(const BlockMatrix<Size>& matrix, int row) {
  using Single = Eigen::Matrix<float, Size, Size>;
  const auto begin = matrix.columns.begin() + matrix.offsets[row];
  const auto end = matrix.columns.begin() + matrix.offsets[row + 1];
  const auto place = std::lower_bound(begin, end, row);
  if (place == end || *place != row) return Single::Identity();
  const Block<Size> diagonal = block_at(matrix, place - matrix.columns.begin());
  constexpr double least_share = 1e-10;  // of its size that a pivot may have
  Block<Size> inverse;
  const bool is_regular = invert_block<Size>(diagonal, least_share * diagonal.norm(), inverse);
  return is_regular ? Single(inverse.template cast<float>()) : Single(Single::Identity());
}

/// Places and radii of aggregates: the mean of their bodies, and the root mean square of how far
/// each reaches from there.
PlaneBodies bodies_of(const Aggregates& aggregates, const PlaneBodies& bodies) {
  PlaneBodies result{Eigen::Matrix2Xd::Zero(2, aggregates.count),
                     Eigen::VectorXd::Zero(aggregates.count)};
  Eigen::VectorXi counts = Eigen::VectorXi::Zero(aggregates.count);
  const auto each_member = [&](const auto& visit) {
    for (std::size_t i = 0; i < aggregates.of_node.size(); ++i) {
      if (aggregates.of_node[i] >= 0) visit(static_cast<int>(i), aggregates.of_node[i]);
    }
  };
  each_member([&](int i, int aggregate) {
    result.places.col(aggregate) += bodies.places.col(i);
    ++counts[aggregate];
  });
  for (int a = 0; a < aggregates.count; ++a) result.places.col(a) /= counts[a];
  each_member([&](int i, int aggregate) {
    result.radii[aggregate] +=
        ((bodies.places.col(i) - result.places.col(aggregate)).squaredNorm() +
         bodies.radii[i] * bodies.radii[i]) /
        counts[aggregate];
  });
  result.radii = result.radii.cwiseSqrt();
  return result;
}

/// How body `from` follows the aggregate `to`; a lone node does not turn it.
template <int Size>
Eigen::Matrix<float, Size, 3> rigid_block(const PlaneBodies& bodies, int from,
                                          const PlaneBodies& aggregates, int to) {
  Block<Size, 3> block = Block<Size, 3>::Identity();
  const double radius = aggregates.radii[to];
  const Eigen::Vector2d arm = bodies.places.col(from) - aggregates.places.col(to);
  const double turn = radius > 0 ? 1 / radius : 0;
  block(0, 2) = -arm[1] * turn;
  block(1, 2) = arm[0] * turn;
  if constexpr (Size == 3) block(2, 2) = bodies.radii[from] * turn;
  return block.template cast<float>();
}

/// `weight(node)` multiplies the rows of a node, (Size).
template <int Size, class Weight>
Transfer<Size, 3> rigid(Aggregates aggregates, PlaneBodies& bodies, const Weight& weight) {
  const PlaneBodies coarse = bodies_of(aggregates, bodies);
  const int nodes = static_cast<int>(aggregates.of_node.size());
  Transfer<Size, 3> transfer;
  transfer.down.reserve(static_cast<std::size_t>(nodes) * Size * 3);
  transfer.up.reserve(transfer.down.capacity());
  for (int node = 0; node < nodes; ++node) {
    const int aggregate = aggregates.of_node[node];
    Eigen::Matrix<float, Size, 3> block = Eigen::Matrix<float, Size, 3>::Zero();
    if (aggregate >= 0) block = rigid_block<Size>(bodies, node, coarse, aggregate);
    append(transfer.down, block);
    const Eigen::Matrix<float, 3, Size> sums = block.transpose() * weight(node).asDiagonal();
    append(transfer.up, sums);
  }
  transfer.aggregates = aggregates;
  bodies = coarse;
  return transfer;
}

/// A P, in double precision and as a level keeps it.
template <int Size, int Coarse>
std::vector<double> product_with_down(const BlockMatrix<Size>& matrix,
                                      const Transfer<Size, Coarse>& transfer,
                                      SingleMatrix<Size, Coarse>& single) {
  std::vector<double> product;
  RowSum<Size, Coarse> sum(transfer.aggregates.count);
  for (int row = 0; row < matrix.rows(); ++row) {
    for (std::int64_t i = matrix.offsets[row]; i < matrix.offsets[row + 1]; ++i) {
      const int node = matrix.columns[i];
      const int aggregate = transfer.aggregates.of_node[node];
      if (aggregate < 0) continue;
      sum.add(aggregate,
              block_at(matrix, i).lazyProduct(widened<Size, Coarse>(transfer.down, node)));
    }
    sum.drain([&](int column, const Block<Size, Coarse>& block) {
      single.append(column, block.data());
      product.insert(product.end(), block.data(), block.data() + block.size());
    });
    single.end_row();
  }
  single.pad();
  return product;
}

}  // namespace

template <int Size>
Transfer<Size, Size> constant_transfer(const BlockMatrix<Size>& matrix,
                                       const Aggregates& aggregates) {
  Transfer<Size, Size> transfer;
  transfer.down.reserve(static_cast<std::size_t>(matrix.rows()) * Size * Size);
  transfer.up.reserve(transfer.down.capacity());
  const Eigen::Matrix<float, Size, Size> unit = Eigen::Matrix<float, Size, Size>::Identity();
  for (int row = 0; row < matrix.rows(); ++row) {
    append(transfer.down, unit);
    append(transfer.up, inverse_diagonal(matrix, row));
  }
  transfer.aggregates = aggregates;
  return transfer;
}

Transfer<2, 3> rigid_transfer(const Aggregates& aggregates, PlaneBodies& bodies,
                              const Eigen::VectorXd& weights) {
  return rigid<2>(aggregates, bodies, [&](int node) -> Eigen::Vector2f {
    return weights.segment<2>(2 * static_cast<Eigen::Index>(node)).cast<float>();
  });
}

Transfer<3, 3> rigid_transfer(const Aggregates& aggregates, PlaneBodies& bodies) {
  return rigid<3>(aggregates, bodies,
                  [](int) -> Eigen::Vector3f { return Eigen::Vector3f::Ones(); });
}

template <int Size, int Coarse>
CoarseLevel<Size, Coarse> coarsen(const BlockMatrix<Size>& matrix,
                                  const Transfer<Size, Coarse>& transfer) {
  CoarseLevel<Size, Coarse> level;
  const std::vector<double> product = product_with_down(matrix, transfer, level.fine_to_coarse);
  const std::vector<std::int64_t>& offsets = level.fine_to_coarse.offsets;
  const Members members(transfer.aggregates);
  RowSum<Coarse, Coarse> sum(transfer.aggregates.count);
  for (int row = 0; row < transfer.aggregates.count; ++row) {
    sum.add(row, Block<Coarse>::Zero());
    Eigen::Matrix<double, Coarse, 1> followers = Eigen::Matrix<double, Coarse, 1>::Zero();
    for (int m = members.offsets[row]; m < members.offsets[row + 1]; ++m) {
      const int node = members.nodes[m];
      const Block<Coarse, Size> up = widened<Coarse, Size>(transfer.up, node);
      followers += up.cwiseAbs().rowwise().sum();
      for (std::int64_t i = offsets[node]; i < offsets[node + 1]; ++i) {
        const Eigen::Map<const Block<Size, Coarse>> block(product.data() + i * Size * Coarse);
        sum.add(level.fine_to_coarse.columns[i], up.lazyProduct(block));
      }
    }
    sum.drain([&](int column, Block<Coarse>& block) {
      for (int i = 0; column == row && i < Coarse; ++i) {
        if (followers[i] == 0) block(i, i) = 1;
      }
      level.matrix.columns.push_back(column);
      level.matrix.values.insert(level.matrix.values.end(), block.data(),
                                 block.data() + block.size());
    });
    level.matrix.offsets.push_back(static_cast<std::int64_t>(level.matrix.columns.size()));
  }
  level.matrix.values.resize(level.matrix.values.size() + block_padding, 0.0);
  return level;
}

#define STRONGPOINT_INSTANTIATE(size) /* every block size that a solver takes */                \
  template Transfer<size, size> constant_transfer(const BlockMatrix<size>&, const Aggregates&); \
  template CoarseLevel<size, size> coarsen(const BlockMatrix<size>&, const Transfer<size, size>&);
STRONGPOINT_INSTANTIATE(1)
STRONGPOINT_INSTANTIATE(2)
STRONGPOINT_INSTANTIATE(3)
STRONGPOINT_INSTANTIATE(4)
#undef STRONGPOINT_INSTANTIATE
template CoarseLevel<2, 3> coarsen(const BlockMatrix<2>&, const Transfer<2, 3>&);

}  // namespace strongpoint
