// Weight functions against the formulas of their sources, on every path.
#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "methods/core/registry.hpp"
#include "methods/core/weight_function.hpp"
#include "tests/simd_paths.hpp"

namespace strongpoint {
namespace {

struct Expected {
  const char* spec;
  double (*squared)(double rho);
};

double square(double x) { return x * x; }

double cubic_spline(double rho) {
  const double q = rho / 1.1;
  return square(q <= 0.5 ? 2.0 / 3 - 4 * q * q + 4 * q * q * q : 4.0 / 3 * std::pow(1 - q, 3));
}

const Expected all_expected[] = {
    {"one", [](double) { return 1.0; }},
    {"bump4", [](double rho) { return std::pow(1 - square(rho / 1.1), 4); }},
    {"cubic_spline", cubic_spline},
    {"quartic_spline",
     [](double rho) {
       const double q = rho / 1.1;
       return square(std::pow(1 - q, 3) * (1 + 3 * q));  // 1 - 6 q^2 + 8 q^3 - 3 q^4
     }},
    {"inverse_cube", [](double rho) { return std::pow(rho, -6); }},
    {"power", [](double rho) { return std::pow(rho, -4); }},
    {"power[p=0]", [](double) { return 1.0; }},
    {"power[p=3]", [](double rho) { return std::pow(rho, -3); }},
    {"power[p=2.5]", [](double rho) { return std::pow(rho, -2.5); }},
    {"power[p=16]", [](double rho) { return std::pow(rho, -16); }},
};

TEST(WeightFunctions, AreThoseOfTheirSourcesOnEveryPath) {
  constexpr double rounding = 1e-11;  // at R the splines are a thousandth of what they add up
  for (const Expected& expected : all_expected) {
    SCOPED_TRACE(expected.spec);
    const auto weight = make_weight(expected.spec).made;
    on_every_path([&] {
      for (int count = 1; count <= 19; ++count) {  // whole packs and what is left of one
        std::vector<double> rho(count);
        for (int i = 0; i < count; ++i) rho[i] = (i + 1.0) / count;
        std::vector<double> found(count + 1, -1);
        weight->squared(rho, std::span(found).first(count));
        for (int i = 0; i < count; ++i) {
          const double exact = expected.squared(rho[i]);
          EXPECT_NEAR(found[i], exact, rounding * exact) << "rho " << rho[i] << " of " << count;
        }
        EXPECT_EQ(found[count], -1) << "what lies beyond is left alone";
      }
    });
  }
}

TEST(WeightFunctions, AllAreChecked) {
  for (const WeightEntry& entry : weight_functions()) {
    const bool is_checked =
        std::any_of(std::begin(all_expected), std::end(all_expected), [&](const Expected& known) {
          const std::string spec = known.spec;
          return spec.substr(0, spec.find('[')) == entry.info.name;
        });
    const bool is_volume = entry.info.name == "volume";  // of a node, not of its distance
    EXPECT_NE(is_checked, is_volume) << entry.info.name;
  }
}

}  // namespace
}  // namespace strongpoint
