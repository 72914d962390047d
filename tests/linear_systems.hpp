#pragma once

#include <random>
#include <string>

#include <Eigen/Dense>

#include "methods/core/error.hpp"
#include "problems/core/random.hpp"
#include "problems/core/solvers.hpp"

namespace strongpoint {

/// The system of a dense matrix, (rows, unknowns), whose zeros are left out.
inline LinearSystem system_of(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& right,
                              int fields = 1) {
  LinearSystem system;
  for (int i = 0; i < matrix.rows(); ++i) {
    for (int j = 0; j < matrix.cols(); ++j) {
      if (matrix(i, j) == 0) continue;
      system.columns.push_back(j);
      system.values.push_back(matrix(i, j));
    }
    system.offsets.push_back(static_cast<std::int64_t>(system.columns.size()));
  }
  system.right_hand_side = right;
  system.fields = fields;
  system.width = matrix.cols();
  return system;
}

/// A matrix of which a share of the entries is not zero, from -1 to 1.
inline Eigen::MatrixXd sparse_matrix(int rows, int columns, double share,
                                     std::mt19937_64& generator) {
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(rows, columns);
  for (int i = 0; i < rows; ++i) {
    for (int j = 0; j < columns; ++j) {
      if (uniform01(generator) < share) matrix(i, j) = 2 * uniform01(generator) - 1;
    }
  }
  return matrix;
}

/// A sparse matrix whose diagonal exceeds half the sum of the rest of its row.
inline Eigen::MatrixXd dominant_matrix(int size, double share, std::mt19937_64& generator) {
  Eigen::MatrixXd matrix = sparse_matrix(size, size, share, generator);
  for (int i = 0; i < size; ++i) matrix(i, i) = 1 + 0.5 * matrix.row(i).cwiseAbs().sum();
  return matrix;
}

/// Entries from -1 to 1.
inline Eigen::VectorXd random_vector(int size, std::mt19937_64& generator) {
  return sparse_matrix(size, 1, 1, generator);
}

/// What an error says; empty when `work` throws no `Error`.
template <class Error, class Work>
std::string message_of(const Work& work) {
  try {
    work();
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

}  // namespace strongpoint
