#include "methods/core/local_solvers.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace strongpoint {

double* HouseholderQr::prepare(int rows, int cols) {
  rows_ = rows;
  cols_ = cols;
  a_.resize(static_cast<std::size_t>(rows) * cols);
  diagonal_.resize(cols);
  beta_.resize(cols);
  return a_.data();
}

void HouseholderQr::reflect(int k, double* v) const {
  const double* reflector = a_.data() + static_cast<std::ptrdiff_t>(k) * rows_;
  double dot = 0;
  for (int i = k; i < rows_; ++i) dot += reflector[i] * v[i];
  dot *= beta_[k];
  for (int i = k; i < rows_; ++i) v[i] -= dot * reflector[i];
}

bool HouseholderQr::factorise(double tolerance) {
  for (int k = 0; k < cols_; ++k) {
    double* column = a_.data() + static_cast<std::ptrdiff_t>(k) * rows_;
    double above = 0;
    double below = 0;
    for (int i = 0; i < k; ++i) above += column[i] * column[i];
    for (int i = k; i < rows_; ++i) below += column[i] * column[i];
    const double length = std::sqrt(below);
    if (!(length > tolerance * std::sqrt(above + below))) return false;
    diagonal_[k] = column[k] > 0 ? -length : length;
    column[k] -= diagonal_[k];
    beta_[k] = -1 / (diagonal_[k] * column[k]);
    for (int j = k + 1; j < cols_; ++j)
      reflect(k, a_.data() + static_cast<std::ptrdiff_t>(j) * rows_);
  }
  return true;
}

void HouseholderQr::solve_transposed_r(std::span<double> g) const {
  for (int k = 0; k < cols_; ++k) {
    const double* column = a_.data() + static_cast<std::ptrdiff_t>(k) * rows_;
    double sum = g[k];
    for (int i = 0; i < k; ++i) sum -= column[i] * g[i];
    g[k] = sum / diagonal_[k];
  }
}

void HouseholderQr::apply_q(std::span<double> v) const {
  for (int k = cols_ - 1; k >= 0; --k) reflect(k, v.data());
}

void HouseholderQr::apply_q_transposed(std::span<double> v) const {
  for (int k = 0; k < cols_; ++k) reflect(k, v.data());
}

double* Ldlt::prepare(int n) {
  n_ = n;
  a_.resize(static_cast<std::size_t>(n) * n);
  return a_.data();
}

bool Ldlt::factorise(double tolerance) {
  for (int i = 0; i < n_; ++i) {
    double* row = a_.data() + static_cast<std::ptrdiff_t>(i) * n_;
    for (int j = 0; j < i; ++j) {
      const double* other = a_.data() + static_cast<std::ptrdiff_t>(j) * n_;
      for (int k = 0; k < j; ++k) row[j] -= row[k] * other[k];
    }
    const double entry = row[i];
    for (int j = 0; j < i; ++j) {
      const double scaled = row[j] / a_[static_cast<std::size_t>(j) * n_ + j];
      row[i] -= row[j] * scaled;
      row[j] = scaled;
    }
    const bool same_sign = row[i] * a_[0] > 0;
    if (!same_sign || !(std::abs(row[i]) > tolerance * std::abs(entry))) return false;
  }
  return true;
}

void Ldlt::solve(std::span<double> b) const {
  for (int i = 0; i < n_; ++i) {
    const double* row = a_.data() + static_cast<std::ptrdiff_t>(i) * n_;
    for (int j = 0; j < i; ++j) b[i] -= row[j] * b[j];
  }
  for (int i = n_ - 1; i >= 0; --i) {
    const double* row = a_.data() + static_cast<std::ptrdiff_t>(i) * n_;
    b[i] /= row[i];
    for (int k = i + 1; k < n_; ++k) b[i] -= a_[static_cast<std::size_t>(k) * n_ + i] * b[k];
  }
}

double* Lu::prepare(int n) {
  n_ = n;
  a_.resize(static_cast<std::size_t>(n) * n);
  largest_.resize(n);
  scale_.resize(n);
  exchanged_.resize(n);
  return a_.data();
}

bool Lu::factorise(double tolerance) {
  std::fill(largest_.begin(), largest_.end(), 0.0);
  for (int i = 0; i < n_; ++i) {
    double largest = 0;
    for (int j = 0; j < n_; ++j) largest = std::max(largest, std::abs(at(i, j)));
    if (!(largest > 0)) return false;
    scale_[i] = 1 / largest;
    for (int j = 0; j < n_; ++j)
      largest_[j] = std::max(largest_[j], scale_[i] * std::abs(at(i, j)));
  }
  for (int k = 0; k < n_; ++k) {
    int pivot = k;
    for (int i = k + 1; i < n_; ++i) {
      if (scale_[i] * std::abs(at(i, k)) > scale_[pivot] * std::abs(at(pivot, k))) pivot = i;
    }
    if (!(scale_[pivot] * std::abs(at(pivot, k)) > tolerance * largest_[k])) return false;
    exchanged_[k] = pivot;
    if (pivot != k) {
      std::swap_ranges(&at(k, 0), &at(k, 0) + n_, &at(pivot, 0));
      std::swap(scale_[k], scale_[pivot]);
    }
    for (int i = k + 1; i < n_; ++i) {
      if (at(i, k) == 0) continue;
      const double factor = at(i, k) / at(k, k);
      at(i, k) = factor;
      for (int j = k + 1; j < n_; ++j) at(i, j) -= factor * at(k, j);
    }
  }
  return true;
}

void Lu::solve(std::span<double> b) const {
  for (int k = 0; k < n_; ++k) std::swap(b[k], b[exchanged_[k]]);
  for (int i = 0; i < n_; ++i) {
    for (int j = 0; j < i; ++j) b[i] -= at(i, j) * b[j];
  }
  for (int i = n_ - 1; i >= 0; --i) {
    for (int j = i + 1; j < n_; ++j) b[i] -= at(i, j) * b[j];
    b[i] /= at(i, i);
  }
}

void Lu::solve_transposed(std::span<double> b) const {
  for (int i = 0; i < n_; ++i) {
    for (int j = 0; j < i; ++j) b[i] -= at(j, i) * b[j];
    b[i] /= at(i, i);
  }
  for (int i = n_ - 1; i >= 0; --i) {
    for (int j = i + 1; j < n_; ++j) b[i] -= at(j, i) * b[j];
  }
  for (int k = n_ - 1; k >= 0; --k) std::swap(b[k], b[exchanged_[k]]);
}

}  // namespace strongpoint
