#include "methods/core/smoothing_kernel.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numbers>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "methods/core/error.hpp"

namespace strongpoint {
namespace {

/// Integral over the space of a kernel's value at radius q, by Simpson's rule on each piece.
template <class Value>
double integral(Value&& value, const std::vector<double>& breaks, int dimension) {
  constexpr int intervals = 2000;
  const std::array<double, 3> sphere{2, 2 * std::numbers::pi, 4 * std::numbers::pi};
  double sum = 0;
  double begin = 0;
  for (double end : breaks) {
    const double step = (end - begin) / intervals;
    for (int i = 0; i <= intervals; ++i) {
      const double q = begin + i * step;
      const double weight = i == 0 || i == intervals ? 1 : i % 2 == 1 ? 4 : 2;
      sum += weight * step / 3 * std::pow(q, dimension - 1) * value(q);
    }
    begin = end;
  }
  return sphere.at(dimension - 1) * sum;
}

}  // namespace

SmoothingKernel::SmoothingKernel(std::string_view name, int dimension) {
  if (name == "gauss") {
    pieces_ = {{2.6, {}}};
    smoothness_ = most_smoothness;
  } else if (name == "cubic_spline") {
    pieces_ = {{1, {1, 0, -1.5, 0.75}}, {2, {2, -3, 1.5, -0.25}}};
  } else if (name == "quartic_spline") {
    pieces_ = {{2, {1, 0, -6.0 / 4, 8.0 / 8, -3.0 / 16}}};
  } else if (name == "wendland") {
    pieces_ = {{2, {1, 0, -10.0 / 4, 20.0 / 8, -15.0 / 16, 4.0 / 32}}};
  } else {
    throw UsageError(fmt::format(
        "unknown kernel '{}'; known: gauss, cubic_spline, quartic_spline, wendland", name));
  }
  std::vector<double> breaks;
  for (const Piece& piece : pieces_) breaks.push_back(piece.end);
  const auto value = [&](double q) {
    double f = 0;
    evaluate(q * q, 0, &f);
    return f;
  };
  normalisation_ = 1 / integral(value, breaks, dimension);
}

void SmoothingKernel::evaluate(double s, int order, double* f) const {
  std::fill(f, f + order + 1, 0.0);
  const double q = std::sqrt(s);
  std::size_t p = 0;
  while (p < pieces_.size() && q > pieces_[p].end) ++p;
  if (p == pieces_.size()) return;
  const std::vector<double>& coefficients = pieces_[p].coefficients;
  if (coefficients.empty()) {
    const double bell = normalisation_ * std::exp(-s);
    for (int m = 0; m <= order; ++m) f[m] = m % 2 == 0 ? bell : -bell;
    return;
  }
  // d^m/ds^m s^(k/2) = (k/2)(k/2 - 1)...(k/2 - m + 1) s^(k/2 - m)
  for (std::size_t k = 0; k < coefficients.size(); ++k) {
    if (coefficients[k] == 0) continue;
    double factor = normalisation_ * coefficients[k];
    for (int m = 0; m <= order && factor != 0; ++m) {
      f[m] += factor * std::pow(q, static_cast<double>(k) - 2 * m);
      factor *= 0.5 * static_cast<double>(k) - m;
    }
  }
}

SmoothingProfile SmoothingKernel::profile() const {
  SmoothingProfile profile{};
  if (pieces_.size() > std::size(profile.piece)) {
    throw std::logic_error("the profile of a smoothing kernel has no room for its pieces");
  }
  for (const Piece& piece : pieces_) {
    SmoothingProfile::Piece& made = profile.piece[profile.pieces++];
    if (piece.coefficients.size() > std::size(made.coefficients)) {
      throw std::logic_error("the profile of a smoothing kernel has no room for its coefficients");
    }
    made.end = piece.end;
    made.height = piece.coefficients.empty() ? normalisation_ : 0;
    std::transform(piece.coefficients.begin(), piece.coefficients.end(), made.coefficients,
                   [&](double coefficient) { return normalisation_ * coefficient; });
  }
  return profile;
}

OptionDoc SmoothingKernel::kernel_option(std::string default_name) {
  return {"kernel", std::move(default_name), "gauss | cubic_spline | quartic_spline | wendland"};
}

OptionDoc SmoothingKernel::length_option(std::string default_length) {
  return {"h", std::move(default_length),
          "smoothing length over the local spacing; the support is 2.6 h (gauss) or 2 h, and "
          "stretched to hold every node of the stencil"};
}

}  // namespace strongpoint
