#include "studies/support/calibration.hpp"

#include <algorithm>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <vector>

#include <Eigen/SparseCore>
#include <Eigen/UmfPackSupport>

#include "studies/support/stage_clock.hpp"

namespace strongpoint {
namespace {

constexpr int runs = 3;

/// The least of the seconds that a piece of work takes.
template <class Work>
double least_seconds(const Work& work) {
  const StageClock clock(1);
  double least = std::numeric_limits<double>::infinity();
  for (int run = 0; run < runs; ++run) {
    double seconds = 0;
    clock.time(seconds, work);
    least = std::min(least, seconds);
  }
  return least;
}

Eigen::SparseMatrix<double> laplacian(int side) {
  const auto id = [side](int i, int j) { return i * side + j; };
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < side; ++i) {
    for (int j = 0; j < side; ++j) {
      entries.emplace_back(id(i, j), id(i, j), 4.0);
      if (i > 0) entries.emplace_back(id(i, j), id(i - 1, j), -1.0);
      if (i + 1 < side) entries.emplace_back(id(i, j), id(i + 1, j), -1.0);
      if (j > 0) entries.emplace_back(id(i, j), id(i, j - 1), -1.0);
      if (j + 1 < side) entries.emplace_back(id(i, j), id(i, j + 1), -1.0);
    }
  }
  Eigen::SparseMatrix<double> matrix(side * side, side * side);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

}  // namespace

Calibration calibrate() {
  constexpr std::size_t numbers = 8'000'000;
  std::vector<double> from(numbers, 1.0);
  std::vector<double> to(numbers, 0.0);
  const double copying =
      least_seconds([&] { std::memcpy(to.data(), from.data(), numbers * sizeof(double)); });
  if (to.back() != 1.0) throw std::logic_error("a copy differs from what was copied");
  const Eigen::SparseMatrix<double> matrix = laplacian(100);
  const double factorising = least_seconds([&] {
    const Eigen::UmfPackLU<Eigen::SparseMatrix<double>> lu(matrix);
    if (lu.info() != Eigen::Success) throw std::logic_error("UMFPACK failed on a Laplacian");
  });
  return {2e-9 * static_cast<double>(numbers * sizeof(double)) / copying, factorising};
}

}  // namespace strongpoint
