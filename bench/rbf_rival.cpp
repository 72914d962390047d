#include "bench/rbf_rival.hpp"

#include <cmath>

#include <Eigen/LU>

namespace {

/// Monomials of degree up to Degree, by degree, then x before y.
template <int Degree>
void fill_monomials(double x, double y, double* values) {
  *values++ = 1;
  for (int order = 1; order <= Degree; ++order) {
    for (int a = 0; a < order; ++a) values[a] = values[a - order] * x;
    values[order] = values[-1] * y;
    values += order + 1;
  }
}

template <int Size, int Degree>
struct Rival {
  static constexpr int terms = (Degree + 1) * (Degree + 2) / 2;
  static constexpr int all = Size + terms;
  Eigen::Matrix<double, Size, 2> z;
  Eigen::Matrix<double, all, all> matrix;
  Eigen::Matrix<double, all, 5> right, solution;
  Eigen::PartialPivLU<Eigen::Matrix<double, all, all>> lu;

  /// Fills the bordered matrix.
  void fill_matrix() {
    matrix.template bottomRightCorner<terms, terms>().setZero();
    for (int j = 0; j < Size; ++j) {
      const Eigen::Array<double, Size, 1> square =
          (z.col(0).array() - z(j, 0)).square() + (z.col(1).array() - z(j, 1)).square();
      matrix.template block<Size, 1>(0, j) = square * square.sqrt();
      fill_monomials<Degree>(z(j, 0), z(j, 1), &matrix(Size, j));
    }
    matrix.template topRightCorner<Size, terms>() =
        matrix.template bottomLeftCorner<terms, Size>().transpose();
  }
  /// Fills the derivatives of r^3 and of the monomials at the centre.
  void fill_right_hand_sides() {
    right.setZero();
    for (int j = 0; j < Size; ++j) {
      const double x = -z(j, 0);
      const double y = -z(j, 1);
      const double r = std::sqrt(x * x + y * y);
      const double inverse = r > 0 ? 3 / r : 0;
      right.row(j) << 3 * x * r, 3 * y * r, 3 * r + x * x * inverse, x * y * inverse,
          3 * r + y * y * inverse;
    }
    const double factors[] = {1, 1, 2, 1, 2};
    for (int d = 0; d < 5; ++d) right(Size + 1 + d, d) = factors[d];
  }
  void run(const RbfRivalTask& task) {
    for (int i = 0; i < task.count; ++i) {
      const int* const ids = task.ids + static_cast<std::int64_t>(i) * Size;
      const double* const centre = task.nodes + 2 * static_cast<std::int64_t>(i);
      for (int j = 0; j < Size; ++j) {
        const double* const node = task.nodes + 2 * static_cast<std::int64_t>(ids[j]);
        z.row(j) << node[0] - centre[0], node[1] - centre[1];
      }
      const double inverse = 1 / z.row(Size - 1).norm();
      z *= inverse;
      fill_matrix();
      fill_right_hand_sides();
      lu.compute(matrix);
      solution.noalias() = lu.solve(right);
      Eigen::Map<Eigen::Matrix<double, 5, Size>> weights(task.values +
                                                         static_cast<std::int64_t>(i) * 5 * Size);
      weights = solution.template topRows<Size>().transpose();
      weights.template topRows<2>() *= inverse;
      weights.template bottomRows<3>() *= inverse * inverse;
    }
  }
};

}  // namespace

void rbf_rival_weights(const RbfRivalTask* task) {
  if (task->size == 15) {
    static thread_local Rival<15, 2> rival;
    rival.run(*task);
  } else {
    static thread_local Rival<30, 4> rival;
    rival.run(*task);
  }
}
