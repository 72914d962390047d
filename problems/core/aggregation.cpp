#include "problems/core/aggregation.hpp"

#include <algorithm>
#include <cstdint>
#include <functional>

namespace strongpoint {
namespace {

template <int Size>
using Block = Eigen::Matrix<double, Size, Size>;

template <int Size>
Eigen::Map<const Block<Size>> block_at(const BlockMatrix<Size>& matrix, std::int64_t place) {
  return Eigen::Map<const Block<Size>>(matrix.values.data() + place * Size * Size);
}

constexpr int outside = -1;
constexpr int undecided = -2;

/// The strong couplings of every row: their columns, and the size that decides between aggregates.
struct Couplings {
  std::vector<std::int64_t> offsets{0};
  std::vector<int> columns;
  std::vector<float> sizes;
};

template <int Size>
Couplings find_couplings(const BlockMatrix<Size>& matrix, const StrongCouplings& strong) {
  // Below this share of the diagonal block a row couples to nothing.
  constexpr double least_share = 1e-8;
  Couplings couplings;
  couplings.offsets.reserve(matrix.rows() + 1);
  std::vector<double> sizes, sorted;
  for (int row = 0; row < matrix.rows(); ++row) {
    const std::int64_t begin = matrix.offsets[row];
    const std::int64_t end = matrix.offsets[row + 1];
    sizes.clear();
    double largest = 0;
    double diagonal = 0;
    for (std::int64_t i = begin; i < end; ++i) {
      sizes.push_back(block_at(matrix, i).norm());
      double& most = matrix.columns[i] == row ? diagonal : largest;
      most = std::max(most, sizes.back());
    }
    double least = std::max(strong.share * largest, least_share * diagonal);
    // The diagonal block, larger than most, is one of them.
    if (static_cast<int>(sizes.size()) > strong.most + 1) {
      sorted = sizes;
      std::nth_element(sorted.begin(), sorted.begin() + strong.most, sorted.end(),
                       std::greater<>());
      least = std::max(least, sorted[strong.most]);
    }
    for (std::int64_t i = begin; i < end; ++i) {
      if (matrix.columns[i] == row || !(sizes[i - begin] >= least) || largest == 0) continue;
      couplings.columns.push_back(matrix.columns[i]);
      couplings.sizes.push_back(static_cast<float>(sizes[i - begin]));
    }
    couplings.offsets.push_back(static_cast<std::int64_t>(couplings.columns.size()));
  }
  return couplings;
}

/// Makes an aggregate of a node and its undecided neighbours.
void found(Aggregates& aggregates, const Couplings& couplings, int node) {
  aggregates.of_node[node] = aggregates.count;
  for (std::int64_t i = couplings.offsets[node]; i < couplings.offsets[node + 1]; ++i) {
    int& neighbour = aggregates.of_node[couplings.columns[i]];
    if (neighbour == undecided) neighbour = aggregates.count;
  }
  ++aggregates.count;
}

/// True when no neighbour is in an aggregate.
bool is_free(const Aggregates& aggregates, const Couplings& couplings, int node) {
  return std::all_of(couplings.columns.begin() + couplings.offsets[node],
                     couplings.columns.begin() + couplings.offsets[node + 1],
                     [&](int neighbour) { return aggregates.of_node[neighbour] < 0; });
}

/// Adds what is undecided to the aggregate it is coupled to most.
void join(Aggregates& aggregates, const Couplings& couplings) {
  const std::vector<int> before = aggregates.of_node;
  for (std::size_t node = 0; node < before.size(); ++node) {
    if (before[node] != undecided) continue;
    float most = 0;
    for (std::int64_t i = couplings.offsets[node]; i < couplings.offsets[node + 1]; ++i) {
      const int aggregate = before[couplings.columns[i]];
      if (aggregate < 0 || couplings.sizes[i] <= most) continue;
      most = couplings.sizes[i];
      aggregates.of_node[node] = aggregate;
    }
  }
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
template <int Size>
class RowSum {
 public:
  explicit RowSum(int columns) : places_(columns, -1) {}

  void add(int column, const Block<Size>& block) {
    int& place = places_[column];
    if (place < 0) {
      place = static_cast<int>(columns_.size());
      columns_.push_back(column);
      blocks_.push_back(Block<Size>::Zero());
    }
    blocks_[place] += block;
  }
  /// Hands each block to `take(column, numbers)` in the order of columns, and forgets the row.
  template <class Take>
  void drain(const Take& take) {
    std::sort(columns_.begin(), columns_.end());
    for (const int column : columns_) {
      take(column, blocks_[places_[column]].data());
      places_[column] = -1;
    }
    columns_.clear();
    blocks_.clear();
  }

 private:
  std::vector<int> places_, columns_;
  std::vector<Block<Size>> blocks_;
};

/// The inverse of a row's diagonal block, or the unit block.
template <int Size>
Block<Size> inverse_diagonal(const BlockMatrix<Size>& matrix, int row) {
  const auto begin = matrix.columns.begin() + matrix.offsets[row];
  const auto end = matrix.columns.begin() + matrix.offsets[row + 1];
  const auto place = std::lower_bound(begin, end, row);
  if (place == end || *place != row) return Block<Size>::Identity();
  const Block<Size> diagonal = block_at(matrix, place - matrix.columns.begin());
  constexpr double least_share = 1e-10;  // of its size that a pivot may have
  Block<Size> inverse;
  const bool is_regular = invert_block<Size>(diagonal, least_share * diagonal.norm(), inverse);
  return is_regular ? inverse : Block<Size>(Block<Size>::Identity());
}

}  // namespace

template <int Size>
Aggregates aggregate(const BlockMatrix<Size>& matrix, const StrongCouplings& strong) {
  const Couplings couplings = find_couplings(matrix, strong);
  Aggregates aggregates;
  aggregates.of_node.assign(matrix.rows(), undecided);
  const auto each_undecided = [&](const auto& visit) {
    for (int node = 0; node < matrix.rows(); ++node) {
      if (aggregates.of_node[node] == undecided) visit(node);
    }
  };
  each_undecided([&](int node) {
    if (couplings.offsets[node] == couplings.offsets[node + 1]) aggregates.of_node[node] = outside;
  });
  each_undecided([&](int node) {
    if (is_free(aggregates, couplings, node)) found(aggregates, couplings, node);
  });
  join(aggregates, couplings);
  each_undecided([&](int node) { found(aggregates, couplings, node); });
  return aggregates;
}

template <int Size>
CoarseLevel<Size> coarsen(const BlockMatrix<Size>& matrix, const Aggregates& aggregates) {
  CoarseLevel<Size> level;
  level.inverses.reserve(static_cast<std::size_t>(matrix.rows()) * Size * Size);
  RowSum<Size> sum(aggregates.count);
  BlockMatrix<Size> product;  // A P
  for (int row = 0; row < matrix.rows(); ++row) {
    const Block<Size> inverse = inverse_diagonal(matrix, row);
    level.inverses.insert(level.inverses.end(), inverse.data(), inverse.data() + Size * Size);
    for (std::int64_t i = matrix.offsets[row]; i < matrix.offsets[row + 1]; ++i) {
      const int aggregate = aggregates.of_node[matrix.columns[i]];
      if (aggregate >= 0) sum.add(aggregate, block_at(matrix, i));
    }
    sum.drain([&](int column, const double* block) {
      level.fine_to_coarse.append(column, block);
      product.columns.push_back(column);
      product.values.insert(product.values.end(), block, block + Size * Size);
    });
    level.fine_to_coarse.end_row();
  }
  level.fine_to_coarse.pad();
  const Members members(aggregates);
  for (int row = 0; row < aggregates.count; ++row) {
    for (int m = members.offsets[row]; m < members.offsets[row + 1]; ++m) {
      const int node = members.nodes[m];
      const Block<Size> inverse =
          Eigen::Map<const Eigen::Matrix<float, Size, Size>>(
              level.inverses.data() + static_cast<std::ptrdiff_t>(node) * Size * Size)
              .template cast<double>();
      const std::vector<std::int64_t>& offsets = level.fine_to_coarse.offsets;
      for (std::int64_t i = offsets[node]; i < offsets[node + 1]; ++i) {
        sum.add(product.columns[i], inverse.lazyProduct(block_at(product, i)));
      }
    }
    sum.drain([&](int column, const double* block) {
      level.matrix.columns.push_back(column);
      level.matrix.values.insert(level.matrix.values.end(), block, block + Size * Size);
    });
    level.matrix.offsets.push_back(static_cast<std::int64_t>(level.matrix.columns.size()));
  }
  level.matrix.values.resize(level.matrix.values.size() + block_padding, 0.0);
  return level;
}

#define STRONGPOINT_INSTANTIATE(size) /* every block size that a solver takes */   \
  template Aggregates aggregate(const BlockMatrix<size>&, const StrongCouplings&); \
  template CoarseLevel<size> coarsen(const BlockMatrix<size>&, const Aggregates&);
STRONGPOINT_INSTANTIATE(1)
STRONGPOINT_INSTANTIATE(2)
STRONGPOINT_INSTANTIATE(3)
STRONGPOINT_INSTANTIATE(4)
#undef STRONGPOINT_INSTANTIATE

}  // namespace strongpoint
