#include "problems/core/wave_branches.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include <Eigen/Eigenvalues>

namespace strongpoint {
namespace {

using Complex = std::complex<double>;
using ComplexMatrix = FieldMatrix<Complex>;

constexpr int most_fields = 3;

/// Takes round-off off an eigenvalue: a real symbol has real frequencies, a zero one none.
Complex cleaned(Complex eigenvalue, double scale) {
  constexpr double round_off = 1e-11;  // of weights from local systems with conditions of 1e4
  const auto clean = [&](double part) { return std::abs(part) < round_off * scale ? 0 : part; };
  return {clean(eigenvalue.real()), clean(eigenvalue.imag())};
}

/// share(b, k): how much of eigenvector k of S lies in the polarisations of waves as fast as wave
/// b.
FieldMatrix<double> shares(const ComplexMatrix& vectors, const FieldMatrix<double>& polarisations,
                           const std::array<double, most_fields>& omega) {
  const Eigen::Index fields = vectors.rows();
  FieldMatrix<double> result = FieldMatrix<double>::Zero(fields, fields);
  constexpr double same = 1e-9;
  for (Eigen::Index b = 0; b < fields; ++b) {
    for (Eigen::Index q = 0; q < fields; ++q) {
      if (std::abs(omega[q] - omega[b]) > same * omega[0]) continue;
      for (Eigen::Index k = 0; k < fields; ++k) {
        result(b, k) += std::norm(polarisations.col(q).cast<Complex>().dot(vectors.col(k)));
      }
    }
  }
  return result;
}

/// The order of the eigenvectors that gives each wave the largest shares, the faster first.
std::array<int, most_fields> matched(const FieldMatrix<double>& share,
                                     const std::array<double, most_fields>& speed) {
  const auto fields = static_cast<int>(share.rows());
  std::array<int, most_fields> order{};
  std::iota(order.begin(), order.end(), 0);
  const auto end = order.begin() + fields;
  std::partial_sort(order.begin(), end, end, [&](int a, int b) {
    return speed[a] > speed[b] || (speed[a] == speed[b] && a < b);
  });
  // Orders are tried from the one by speed, which therefore wins where shares tell nothing.
  std::array<int, most_fields> places{};
  std::iota(places.begin(), places.end(), 0);
  std::array<int, most_fields> best = order;
  double most = -1;
  do {
    double sum = 0;
    for (int b = 0; b < fields; ++b) sum += share(b, order[places[b]]);
    constexpr double tie = 1e-9;
    if (sum <= most + tie) continue;
    most = sum;
    for (int b = 0; b < fields; ++b) best[b] = order[places[b]];
  } while (std::next_permutation(places.begin(), places.begin() + fields));
  return best;
}

/// Diagonal of X^-1 dS X, the derivatives of the eigenvalues.
std::optional<Eigen::Matrix<Complex, Eigen::Dynamic, 1, 0, most_fields, 1>> slopes(
    const ComplexMatrix& vectors, const ComplexMatrix& slope) {
  if (vectors.rows() == 1) return slope.diagonal();
  constexpr double defective = 1e-10;  // of normalised eigenvectors
  const Eigen::FullPivLU<ComplexMatrix> factors(vectors);
  if (factors.rcond() < defective) return std::nullopt;
  const ComplexMatrix turned = factors.solve((slope * vectors).eval());
  return turned.diagonal();
}

}  // namespace

std::vector<std::string> branch_names(int fields) {
  if (fields == 1) return {"P"};
  if (fields == 2) return {"P", "S"};
  return {"P", "S1", "S2"};
}

template <int Dim>
std::vector<Branch> branches(const NodeSymbol<Dim>& symbol, const ExactSymbol<Dim>& exact,
                             const Point<Dim>& xi, const Point<Dim>& direction) {
  const auto along = symbol.along(xi, direction);
  if (!along) return {};
  const int fields = symbol.fields();
  const Eigen::SelfAdjointEigenSolver<FieldMatrix<double>> known(exact.at(xi));  // ascending
  const Eigen::ComplexEigenSolver<ComplexMatrix> found(along->symbol);
  std::array<double, most_fields> omega{};
  std::array<double, most_fields> speed{};
  for (int f = 0; f < fields; ++f) {
    omega[f] = std::sqrt(std::max(0.0, -known.eigenvalues()[f]));
    speed[f] = std::sqrt(-found.eigenvalues()[f]).real();
  }
  const std::array<int, most_fields> order =
      matched(shares(found.eigenvectors(), known.eigenvectors(), omega), speed);
  const auto turned = slopes(found.eigenvectors(), along->slope);
  std::vector<Branch> result;
  result.reserve(static_cast<std::size_t>(fields));
  for (int b = 0; b < fields; ++b) {
    const int k = order[b];
    result.push_back({cleaned(found.eigenvalues()[k], symbol.scale()),
                      turned ? std::optional<Complex>((*turned)[k]) : std::nullopt, omega[b]});
  }
  return result;
}

template <int Dim>
std::vector<Complex> eigenvalues(const NodeSymbol<Dim>& symbol, const Point<Dim>& xi) {
  const std::optional<ComplexMatrix> matrix = symbol.at(xi);
  if (!matrix) return {};
  const Eigen::ComplexEigenSolver<ComplexMatrix> found(*matrix, false);
  std::vector<Complex> result;
  result.reserve(static_cast<std::size_t>(symbol.fields()));
  for (const Complex& eigenvalue : found.eigenvalues()) {
    result.push_back(cleaned(eigenvalue, symbol.scale()));
  }
  return result;
}

Frequency frequency(Complex eigenvalue, std::optional<double> dt) {
  const Complex exact = std::sqrt(-eigenvalue);
  const Complex half = dt ? std::asin(exact * (*dt / 2)) : Complex(0);
  Complex omega = dt ? half * (2 / *dt) : exact;
  Complex per_eigenvalue = -0.5 / exact;
  if (dt) per_eigenvalue /= std::cos(half);
  if (eigenvalue.imag() == 0 && omega.imag() > 0) {
    omega = std::conj(omega);
    per_eigenvalue = std::conj(per_eigenvalue);
  }
  const bool is_finite =
      std::isfinite(per_eigenvalue.real()) && std::isfinite(per_eigenvalue.imag());
  return {omega, is_finite ? std::optional<Complex>(per_eigenvalue) : std::nullopt};
}

#define STRONGPOINT_INSTANTIATE(Dim) /* the same for each dimension */                   \
  template std::vector<Branch> branches(const NodeSymbol<Dim>&, const ExactSymbol<Dim>&, \
                                        const Point<Dim>&, const Point<Dim>&);           \
  template std::vector<Complex> eigenvalues(const NodeSymbol<Dim>&, const Point<Dim>&)
STRONGPOINT_INSTANTIATE(1);
STRONGPOINT_INSTANTIATE(2);
STRONGPOINT_INSTANTIATE(3);
#undef STRONGPOINT_INSTANTIATE

}  // namespace strongpoint
