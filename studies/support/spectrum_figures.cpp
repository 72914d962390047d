#include "studies/support/spectrum_figures.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include <fmt/format.h>

#include "methods/core/error.hpp"
#include "problems/core/sparse_growth.hpp"

namespace strongpoint {
namespace {

Figure finite(double value, const char* otherwise) {
  if (std::isfinite(value)) return {value, {}};
  return {std::nullopt, otherwise};
}

}  // namespace

SpectrumFigures dense_figures(const Motion& motion) {
  SpectrumFigures figures;
  figures.complete = true;
  const EigenPairs pairs = dense_eigenpairs(motion);
  figures.radius = pairs.values.cwiseAbs().maxCoeff();
  figures.largest_real = {pairs.values.real().maxCoeff(), {}};
  figures.largest_imaginary = {pairs.values.imag().cwiseAbs().maxCoeff(), {}};
  figures.growth_rate = {growth_rate(pairs.values), {}};
  figures.non_normality =
      finite(eigenvector_condition(pairs), "infinite: the eigenvectors are linearly dependent");
  figures.residual = finite(eigen_residual(motion, pairs), "infinite: an eigenvalue is exactly 0");
  Eigen::Index fastest = 0;
  if (pairs.values.cwiseSqrt().real().maxCoeff(&fastest) > 0) {
    figures.fastest = {pairs.values.segment(fastest, 1), pairs.vectors.col(fastest)};
  }
  std::vector<Eigen::Index> order(pairs.values.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](Eigen::Index a, Eigen::Index b) {
    return std::abs(pairs.values[a]) < std::abs(pairs.values[b]);
  });
  figures.modes = {pairs.values(order), pairs.vectors(Eigen::all, order)};
  return figures;
}

SpectrumFigures sparse_figures(const Motion& motion, int count) {
  SpectrumFigures figures;
  figures.radius = spectral_radius(motion);
  figures.modes = lowest_modes(motion, std::min(count, motion.size()));
  figures.non_normality.reason =
      "needs all eigenvectors; ask for --engine dense, or a coarser level";
  constexpr std::int64_t budget = 100000;
  const FoundGrowth growth = find_growth(motion, figures.radius, budget);
  figures.largest_imaginary.reason = "needs all eigenvalues; ask for --engine dense";
  double real = figures.modes.values.real().maxCoeff();
  if (growth.rate > 0) {
    figures.growth_rate = {growth.rate, {}};
    figures.residual = {growth.residual, {}};
    figures.fastest = {Eigen::VectorXcd::Constant(1, growth.eigenvalue), growth.vector};
    figures.largest_imaginary = {std::abs(growth.eigenvalue.imag()),
                                 "at least: that of the fastest growing vibration"};
    real = std::max(real, growth.eigenvalue.real());
  } else {
    figures.growth_rate = {
        0, fmt::format("no growth faster than {:.2g} is seen after {} products with the operator",
                       growth.bound, growth.products)};
    figures.residual = {eigen_residual(motion, figures.modes), "of the lowest modes"};
  }
  figures.largest_real = {
      real, fmt::format("of the {} lowest and the fastest growing", figures.modes.values.size())};
  return figures;
}

}  // namespace strongpoint
