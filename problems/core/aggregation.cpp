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

// Every block size that a solver takes.
template Aggregates aggregate(const BlockMatrix<1>&, const StrongCouplings&);
template Aggregates aggregate(const BlockMatrix<2>&, const StrongCouplings&);
template Aggregates aggregate(const BlockMatrix<3>&, const StrongCouplings&);
template Aggregates aggregate(const BlockMatrix<4>&, const StrongCouplings&);

}  // namespace strongpoint
