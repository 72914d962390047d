#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace strongpoint {

/// The unknowns that the nodes of some sites stand for: most nodes are unknowns themselves, a
/// mirror image stands for the node it mirrors, nodes of patches may share one.
struct NodeUnknowns {
  int count = 0;              ///< nodes that are unknowns, ids 0 to count - 1 of the unknowns
  std::vector<int> source{};  ///< (nodes of the sites) the unknown of each; empty: each its own
  std::vector<std::uint8_t> mirrored{};  ///< (nodes of the sites) bit c: mirrored along axis c;
                                         ///< empty: none
  std::vector<int> field_axis{};         ///< (fields) axis of a vector's component, -1 for a scalar

  std::vector<int> numbers{};  ///< what messages call the first nodes; empty: their ids

  /// What messages call a node.
  int number_of(int node) const {
    return node < static_cast<int>(numbers.size()) ? numbers[node] : node;
  }
  bool is_identity() const { return source.empty(); }
  /// -1 where the mirror image of a field has the opposite sign, else 1.
  double sign(int node, int field) const {
    if (mirrored.empty() || field_axis[field] < 0) return 1;
    return (mirrored[node] >> field_axis[field] & 1U) != 0 ? -1 : 1;
  }
  int of(int node) const { return source.empty() ? node : source[node]; }
  /// Values of the unknowns, (fields, count), spread over all nodes of the sites.
  Eigen::MatrixXd spread(const Eigen::MatrixXd& values) const {
    if (is_identity()) return values;
    Eigen::MatrixXd all(values.rows(), static_cast<Eigen::Index>(source.size()));
    for (std::size_t n = 0; n < source.size(); ++n) {
      const auto node = static_cast<int>(n);
      for (int f = 0; f < values.rows(); ++f) {
        all(f, node) = sign(node, f) * values(f, source[n]);
      }
    }
    return all;
  }
};

}  // namespace strongpoint
