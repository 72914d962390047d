#include "methods/core/fornberg.hpp"

#include <algorithm>

namespace strongpoint {

Eigen::MatrixXd fornberg_weights(std::span<const double> nodes, double x, int order) {
  Eigen::MatrixXd weights(order + 1, static_cast<Eigen::Index>(nodes.size()));
  fornberg_weights(nodes, x, weights);
  return weights;
}

void fornberg_weights(std::span<const double> nodes, double x,
                      Eigen::Ref<Eigen::MatrixXd> weights) {
  const int n = static_cast<int>(nodes.size());
  const int order = static_cast<int>(weights.rows()) - 1;
  weights.setZero();
  weights(0, 0) = 1;
  double before = 1;  // product of the last node's distances from those before it
  for (int i = 1; i < n; ++i) {
    double product = 1;
    const int most = std::min(i, order);
    for (int j = 0; j < i; ++j) {
      const double distance = nodes[i] - nodes[j];
      product *= distance;
      if (j == i - 1) {
        for (int k = most; k >= 0; --k) {
          const double lower = k > 0 ? k * weights(k - 1, i - 1) : 0;
          weights(k, i) = before * (lower - (nodes[i - 1] - x) * weights(k, i - 1)) / product;
        }
      }
      for (int k = most; k >= 0; --k) {
        const double lower = k > 0 ? k * weights(k - 1, j) : 0;
        weights(k, j) = ((nodes[i] - x) * weights(k, j) - lower) / distance;
      }
    }
    before = product;
  }
}

}  // namespace strongpoint
