#include "bench/taylor_rival.hpp"

#include <Eigen/LU>

namespace {

/// One stencil after the other, in storage of fixed size.
template <int Dim, int Size>
struct Rival {
  static constexpr int terms = Dim * (Dim + 3) / 2;
  using Square = Eigen::Matrix<double, terms, terms>;
  Eigen::Matrix<double, Dim, Size> z;
  Eigen::Matrix<double, terms, Size> basis;
  Square moments;
  Eigen::Matrix<double, terms, Eigen::Dynamic, 0, terms, terms> right, solution;
  Eigen::PartialPivLU<Square> lu;

  void fill_basis() {
    for (int j = 0; j < Size; ++j) {
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
    for (int i = 0; i < task.count; ++i) {
      const int* const ids = task.ids + static_cast<std::int64_t>(i) * Size;
      const Eigen::Map<const Eigen::Matrix<double, Dim, 1>> centre(
          task.nodes + static_cast<std::int64_t>(i) * Dim);
      for (int j = 0; j < Size; ++j) {
        z.col(j) = Eigen::Map<const Eigen::Matrix<double, Dim, 1>>(
                       task.nodes + static_cast<std::int64_t>(ids[j]) * Dim) -
                   centre;
      }
      const double inverse = 1 / z.col(Size - 1).norm();
      z *= inverse;
      fill_basis();
      moments.noalias() = basis * basis.transpose();
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
      Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, Size>> weights(
          task.values + static_cast<std::int64_t>(i) * count * Size, count, Size);
      weights.noalias() = solution.transpose() * basis;
      weights.col(0) = -weights.template rightCols<Size - 1>().rowwise().sum();
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
    static thread_local Rival<2, 15> rival;
    rival.run(*task, is_laplacian ? squares : every);
  } else {
    static thread_local Rival<3, 30> rival;
    rival.run(*task, is_laplacian ? squares_3d : every);
  }
}
