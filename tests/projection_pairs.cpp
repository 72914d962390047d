// Pairs of projection functions in 1D: finite differences, plain MFPM, dispersion, refusals.
#include <array>
#include <cmath>
#include <complex>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/contract_support.hpp"

namespace strongpoint {
namespace {

/// Weights of u' and u'' at one node of a line.
Weights line_weights(const std::string& spec, const Points<1>& nodes, int centre) {
  Sites<1> sites = sites_at_nodes<1>(nodes);
  std::fill(sites.wanted.begin(), sites.wanted.end(), 0);
  std::vector<int> all(nodes.cols());
  for (int i = 0; i < nodes.cols(); ++i) all[i] = i;
  sort_stencil<1>(sites, centre, all);
  Stencils stencils;
  for (int a = 0; a < nodes.cols(); ++a) {
    stencils.push_back(a == centre ? std::span<const int>(all) : std::span<const int>{});
  }
  return make_method<1>(spec).made->weights(sites, stencils, {{1}, {2}});
}

constexpr std::array pairs{"constant+linear", "linear+quadratic", "quadratic+cubic",
                           "constant+cubic"};

std::string with(const std::string& pair) { return "mfpm[projection=" + pair + "]"; }

TEST(ProjectionPairs, AreFiniteDifferencesOnThreeNodes) {
  Points<1> nodes(1, 3);
  nodes << 0.3, 0.37, 0.5;
  for (const char* pair : pairs) {
    for (int centre = 0; centre < 3; ++centre) {
      const Weights weights = line_weights(with(pair), nodes, centre);
      for (int j = 0; j < 3; ++j) {
        const int node = weights.nodes(centre)[j];
        const double p = nodes((node + 1) % 3);
        const double q = nodes((node + 2) % 3);
        const double below = (nodes(node) - p) * (nodes(node) - q);
        EXPECT_NEAR(weights.row(centre)(0, j) * below, 2 * nodes(centre) - p - q, 1e-12) << pair;
        EXPECT_NEAR(weights.row(centre)(1, j) * below, 2, 1e-11) << pair;
      }
    }
  }
}

TEST(ProjectionPairs, OfLinearAndQuadraticArePlainMfpmOnFiveNodes) {
  Points<1> nodes(1, 5);
  nodes << 0.3, 0.37, 0.5, 0.56, 0.68;
  for (int centre = 0; centre < 5; ++centre) {
    const Weights pair = line_weights(with("quadratic+linear"), nodes, centre);
    const Weights plain = line_weights("mfpm", nodes, centre);
    for (std::size_t i = 0; i < pair.values.size(); ++i) {
      EXPECT_NEAR(pair.values[i], plain.values[i], 1e-12 * (1 + std::abs(plain.values[i])));
    }
    const Weights other = line_weights(with("constant+linear"), nodes, centre);
    EXPECT_GT(std::abs(other.values[1] - plain.values[1]), 1e-2);
  }
}

/// omega / xi of (4.38) as the time step goes to zero, at xi h / pi; h = 1.
double dispersion(const std::string& spec, int half, double xi) {
  Points<1> nodes(1, 2 * half + 1);
  for (int i = 0; i <= 2 * half; ++i) nodes(i) = i - half;
  const Weights weights = line_weights(spec, nodes, half);
  std::complex<double> sum;
  for (int j = 0; j <= 2 * half; ++j) {
    const double x = nodes(weights.nodes(half)[j]);
    sum += weights.row(half)(1, j) * std::exp(std::complex<double>(0, -xi * std::numbers::pi * x));
  }
  EXPECT_NEAR(sum.imag(), 0, 1e-12);
  return std::sqrt(-sum.real()) / (xi * std::numbers::pi);
}

TEST(ProjectionPairs, OnAUniformGridDisperseWavesAsIsKnown) {
  const std::array at{0.1, 0.3, 0.5, 0.7, 1.0};
  const std::array three{0.9959, 0.9634, 0.9003, 0.8103, 0.6366};
  const std::array linear_quadratic{0.9844, 0.8649, 0.6551, 0.4074, 0.1544};
  const std::array constant_linear{0.9861, 0.8804, 0.6974, 0.4895, 0.2847};
  for (std::size_t i = 0; i < at.size(); ++i) {
    EXPECT_NEAR(dispersion(with("linear+quadratic"), 1, at[i]), three[i], 5.1e-5);
    EXPECT_NEAR(dispersion(with("linear+quadratic"), 2, at[i]), linear_quadratic[i], 5.1e-5);
    EXPECT_NEAR(dispersion(with("constant+linear"), 2, at[i]), constant_linear[i], 5.1e-5);
  }
}

TEST(ProjectionPairs, RefuseWhatIsSingularAndWhatIsNotTheirs) {
  const auto message_of = [](const std::string& spec) -> std::string {
    try {
      make_method<1>(spec);
    } catch (const UsageError& error) {
      return error.what();
    }
    return "no error";
  };
  EXPECT_NE(message_of(with("constant+quadratic")).find("both even"), std::string::npos);
  EXPECT_NE(message_of(with("linear+cubic")).find("both odd"), std::string::npos);
  EXPECT_NE(message_of(with("linear+linear")).find("the same"), std::string::npos);
  EXPECT_NE(message_of(with("linear")).find("allowed"), std::string::npos);
  EXPECT_NE(message_of("mfpm[order=3,projection=linear+quadratic]").find("order=2"),
            std::string::npos);
  EXPECT_NE(make_method<2>(with("linear+quadratic")).made->unsupported({}).find("1D only"),
            std::string::npos);
  EXPECT_EQ(make_method<1>(with("quadratic+linear")).spec, with("linear+quadratic"));
}

}  // namespace
}  // namespace strongpoint
