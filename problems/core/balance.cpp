#include "problems/core/balance.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace strongpoint {
namespace {

constexpr int fields = 2;

/// Moments of a row about its node: of order 0, 1 and 2, with those of its absolute entries.
struct Moments {
  std::array<double, 2> value{};
  std::array<double, 4> first{};
  std::array<double, 6> second{};
  std::array<double, 3> most{};
  double diagonal = 0;

  template <std::size_t Count>
  static double size(const std::array<double, Count>& numbers) {
    double sum = 0;
    for (const double number : numbers) sum += number * number;
    return std::sqrt(sum);
  }
};

Moments moments_of(const LinearSystem& system, std::int64_t row) {
  Moments moments;
  const Eigen::Vector2d centre = system.places.col(row / fields);
  for (std::int64_t i = system.offsets[row]; i < system.offsets[row + 1]; ++i) {
    const std::int64_t column = system.columns[i];
    const int field = static_cast<int>(column % fields);
    const double a = system.values[i];
    if (column == row) moments.diagonal = a;
    const Eigen::Vector2d arm = system.places.col(column / fields) - centre;
    moments.value[field] += a;
    moments.first[2 * field] += a * arm[0];
    moments.first[2 * field + 1] += a * arm[1];
    moments.second[3 * field] += a * arm[0] * arm[0] / 2;
    moments.second[3 * field + 1] += a * arm[0] * arm[1];
    moments.second[3 * field + 2] += a * arm[1] * arm[1] / 2;
    moments.most[0] += std::abs(a);
    moments.most[1] += std::abs(a) * arm.norm();
    moments.most[2] += std::abs(a) * arm.squaredNorm();
  }
  return moments;
}

/// The order of the derivatives that a row takes, 0 to 2.
int order_of(const Moments& moments) {
  // A value takes all of its row, a one-sided derivative of high order some hundredth; what is left
  // to the other orders is a truncation or the gradient of a coefficient.
  constexpr double least_value = 0.1;
  constexpr double least_of_second = 0.3;
  if (Moments::size(moments.value) > least_value * moments.most[0]) return 0;
  const double first = Moments::size(moments.first) / moments.most[1];
  const double second = Moments::size(moments.second) / moments.most[2];
  return first > least_of_second * second ? 1 : 2;
}

/// The spacing around a node: the geometric mean of the distances to the four nearest in the longer
/// of its rows; 1 where there are none. `squares` is scratch.
double spacing_at(const LinearSystem& system, std::int64_t node, std::vector<double>& squares) {
  constexpr std::size_t most = 4;
  const std::int64_t* offsets = system.offsets.data() + node * fields;
  const int longer = offsets[2] - offsets[1] > offsets[1] - offsets[0] ? 1 : 0;
  squares.clear();
  std::int64_t previous = node;
  for (std::int64_t i = offsets[longer]; i < offsets[longer + 1]; ++i) {
    const std::int64_t other = system.columns[i] / fields;
    if (other == node || other == previous) continue;
    previous = other;
    const double square = (system.places.col(other) - system.places.col(node)).squaredNorm();
    if (square > 0) squares.push_back(square);
  }
  if (squares.empty()) return 1;
  const std::size_t count = std::min(most, squares.size());
  std::partial_sort(squares.begin(), squares.begin() + count, squares.end());
  double product = 1;
  for (std::size_t i = 0; i < count; ++i) product *= squares[i];
  return std::pow(product, 0.5 / static_cast<double>(count));
}

/// What the rows of a node are multiplied by, before they were scaled, and 0 for rows of values;
/// one number for both, which would be alone in their units otherwise. Gives the mean of the
/// diagonal entries in turn.
struct NodeWeight {
  std::array<double, fields> weights{};
  double diagonal = 0;
  int rows = 0;
  bool has_traction = false;
};

NodeWeight weigh(const LinearSystem& system, std::int64_t node, std::vector<double>& squares) {
  NodeWeight result;
  std::array<bool, fields> is_value{};
  std::array<double, fields> scales{};
  double squared = 0;
  double trace = 0;
  int order = 2;
  for (int field = 0; field < fields; ++field) {
    const std::int64_t row = node * fields + field;
    const Moments moments = moments_of(system, row);
    scales[field] = system.row_scales.empty() ? 1 : system.row_scales[row];
    const int own = order_of(moments);
    is_value[field] = own == 0;
    if (own == 0) continue;
    order = std::min(order, own);
    // A Laplacian and a normal derivative both have the size 1.
    const double size =
        own == 1 ? Moments::size(moments.first) : Moments::size(moments.second) / std::sqrt(2.0);
    squared += std::pow(size / scales[field], 2);
    trace += moments.diagonal / scales[field];
    ++result.rows;
  }
  result.has_traction = order == 1;
  if (result.rows == 0 || !(squared > 0) || trace == 0) return {};
  const double length = spacing_at(system, node, squares);
  const double weight =
      std::copysign(std::pow(length, order), -trace) / std::sqrt(squared / result.rows);
  for (int field = 0; field < fields; ++field) {
    if (!is_value[field]) result.weights[field] = weight / scales[field];
  }
  result.diagonal = weight * trace / result.rows;
  return result;
}

}  // namespace

Balance balance_of(const LinearSystem& system) {
  Balance balance{Eigen::VectorXd::Zero(system.rows()),
                  std::vector<char>(system.rows() / fields, 0)};
  Eigen::VectorXd& weights = balance.weights;
  std::vector<double> squares;
  double diagonals = 0;
  std::int64_t count = 0;
  for (std::int64_t node = 0; node < system.rows() / fields; ++node) {
    const NodeWeight weight = weigh(system, node, squares);
    for (int field = 0; field < fields; ++field) {
      weights[node * fields + field] = weight.weights[field];
    }
    if (weight.rows == 0) continue;
    balance.has_traction[node] = weight.has_traction ? 1 : 0;
    diagonals += weight.diagonal;
    ++count;
  }
  const double mean = count > 0 ? diagonals / static_cast<double>(count) : 1;
  for (std::int64_t row = 0; row < system.rows(); ++row) {
    if (weights[row] != 0) continue;
    const double diagonal = moments_of(system, row).diagonal;
    weights[row] = diagonal != 0 ? mean / diagonal : 1;
  }
  return balance;
}

}  // namespace strongpoint
