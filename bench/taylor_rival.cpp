#include "bench/taylor_rival.hpp"

#include <Eigen/LU>

namespace {

/// One stencil after the other, as a library of strong forms does: the code is made for a dimension
/// and an order, the number of nodes and the weight function are known when it
/// runs.
template <int Dim>
struct Rival {
  static constexpr int terms = Dim * (Dim + 3) / 2;
  using Square = Eigen::Matrix<double, terms, terms>;
  Eigen::Matrix<double, Dim, Eigen::Dynamic> z;
  Eigen::Matrix<double, terms, Eigen::Dynamic> basis, weighted;
  Eigen::RowVectorXd distances, squared;  ///< over R; T^2
  Square moments;
  Eigen::Matrix<double, terms, Eigen::Dynamic, 0, terms, terms> right, solution;
  Eigen::PartialPivLU<Square> lu;

  void resize(int size) {
    z.resize(Dim, size);
    basis.resize(terms, size);
    weighted.resize(terms, size);
    distances.resize(size);
    squared.resize(size);
  }
  /// Fills the positions over the stencil's radius; returns 1 / R.
  double gather(const double* nodes, const int* ids, int centre_place) {
    using Place = Eigen::Map<const Eigen::Matrix<double, Dim, 1>>;
    const Place centre(nodes + static_cast<std::int64_t>(centre_place) * Dim);
    for (int j = 0; j < z.cols(); ++j) {
      z.col(j) = Place(nodes + static_cast<std::int64_t>(ids[j]) * Dim) - centre;
    }
    const double inverse = 1 / z.col(z.cols() - 1).norm();  // the farthest comes last
    z *= inverse;
    return inverse;
  }
  void fill_basis() {
    for (int j = 0; j < z.cols(); ++j) {
      int place = 0;
      for (int a = 0; a < Dim; ++a) basis(place++, j) = z(a, j);
      for (int a = 0; a < Dim; ++a) {
        for (int b = a; b < Dim; ++b) basis(place++, j) = z(a, j) * z(b, j);
      }
    }
  }
  /// True for z_a^2, whose second derivative is 2.
  static bool is_square(int monomial) {
    return Dim == 2 ? monomial == 2 || monomial == 4
                    : monomial == 3 || monomial == 6 || monomial == 8;
  }
  void run(const TaylorRivalTask& task, const int* monomials) {
    const int count = task.derivatives;
    const int size = task.size;
    resize(size);
    for (int i = 0; i < task.count; ++i) {
      const double inverse = gather(task.nodes, task.ids + static_cast<std::int64_t>(i) * size, i);
      fill_basis();
      if (task.weigh != nullptr) {
        distances = z.colwise().norm();
        task.weigh(distances.data(), size, squared.data());
        squared[0] = 0;  // the centre's value is known
        weighted.noalias() = basis * squared.asDiagonal();
      }
      const auto& weighed = task.weigh == nullptr ? basis : weighted;  // the centre's basis is 0
      moments.noalias() = weighed * basis.transpose();
      lu.compute(moments);
      if (task.conditions != nullptr) {
        const Square inverted = lu.inverse();
        task.conditions[i] = moments.cwiseAbs().colwise().sum().maxCoeff() *
                             inverted.cwiseAbs().colwise().sum().maxCoeff();
      }
      right.setZero(terms, count);
      for (int d = 0; d < count; ++d) {
        const int a = monomials[d];
        right(a, d) = (a < Dim ? inverse : inverse * inverse) * (is_square(a) ? 2 : 1);
      }
      solution = lu.solve(right);
      Eigen::Map<Eigen::MatrixXd> weights(task.values + static_cast<std::int64_t>(i) * count * size,
                                          count, size);
      weights.noalias() = solution.transpose() * weighed;
      weights.col(0) = -weights.rightCols(size - 1).rowwise().sum();
    }
  }
};

}  // namespace

void taylor_rival_weights(const TaylorRivalTask* task) {
  static constexpr int every[] = {0, 1, 2, 3, 4, 5, 6, 7, 8};
  static constexpr int squares[] = {2, 4};
  static constexpr int squares_3d[] = {3, 6, 8};
  const bool is_laplacian = task->derivatives == task->dim;
  if (task->dim == 2) {
    static thread_local Rival<2> rival;
    rival.run(*task, is_laplacian ? squares : every);
  } else {
    static thread_local Rival<3> rival;
    rival.run(*task, is_laplacian ? squares_3d : every);
  }
}
