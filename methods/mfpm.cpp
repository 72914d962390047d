#include <algorithm>
#include <array>
#include <cmath>

#include "methods/core/absent_method.hpp"
#include "methods/core/projection_fit.hpp"
#include "methods/core/registry.hpp"
#include "methods/core/taylor_fit.hpp"

namespace strongpoint {
namespace {

/// Powers of the two projection functions, the lower one first.
struct Pair {
  int low, high;
};

/// The projection functions by power, as a spec names them.
constexpr std::array functions{"constant", "linear", "quadratic", "cubic"};

int power_of(const std::string& name) {
  const auto* const place = std::find(functions.begin(), functions.end(), name);
  if (place != functions.end()) return static_cast<int>(place - functions.begin());
  throw UsageError(
      fmt::format("mfpm: '{}' is no projection function; allowed: monomials, or two of constant, "
                  "linear, quadratic, cubic such as linear+quadratic",
                  name));
}

/// Reads two different functions joined by '+', and sets the option to the lower power first.
Pair read_pair(Options& options) {
  const std::string text = options.text("projection");
  const std::size_t plus = std::min(text.find('+'), text.size());
  const int first = power_of(text.substr(0, plus));
  const int second = power_of(text.substr(std::min(plus + 1, text.size())));
  const auto [low, high] = std::minmax(first, second);
  if ((high - low) % 2 == 0) {
    throw UsageError(
        fmt::format("mfpm: the projection functions of {} are {}, so that symmetric stencils are "
                    "singular; take an even one (constant, quadratic) and an odd one (linear, "
                    "cubic)",
                    text,
                    high == low    ? "the same"
                    : low % 2 == 0 ? "both even"
                                   : "both odd"));
  }
  if (options.integer("order", 1, 8) != 2) {
    throw UsageError(
        fmt::format("mfpm: two projection functions give two derivatives: projection={} goes with "
                    "order=2 only",
                    text));
  }
  options.set("projection", fmt::format("{}+{}", functions[low], functions[high]));
  return {low, high};
}

/// u' and u'' from two projections of u(x) - u_i.
template <int Dim>
std::unique_ptr<Method<Dim>> make_pair_method(const Pair& pair) {
  if constexpr (Dim == 1) {
    const Projections<1> powers = [pair](const LocalStencil<1>& stencil, double* values) {
      for (int j = 0; j < stencil.size; ++j) {
        *values++ = std::pow(stencil.z[j], pair.low);
        *values++ = std::pow(stencil.z[j], pair.high);
      }
    };
    return std::make_unique<ProjectionMethod<1>>(
        ProjectionFit<1>({Derivatives<1>::between_orders(1, 2)}, powers),
        ProjectionMethod<1>::Traits{
            "mfpm", {.reproduces = 2}, {.centre = true}, 3, default_lean_stencil(Dim, 2)});
  } else {
    return std::make_unique<AbsentMethod<Dim>>(
        "mfpm with two projection functions exists in 1D only; leave projection=monomials");
  }
}

}  // namespace

/// Modified Finite Particle Method, novel formulation. With the thesis' projection functions (the
/// monomials) it is the unweighted least-squares Taylor fit with the value at the centre
/// eliminated; in 1D other pairs of functions can be chosen. Source: Asprone, Auricchio, Montanino,
/// Reali 2014; thesis 3.2, sign in (3.27) corrected; 4.4.2 for the pairs, of which those of equal
/// parity are left out.
MethodEntry method_mfpm() {
  return {{"mfpm",
           "Modified Finite Particle Method, novel formulation: unweighted Taylor fit",
           {{"order", "2", "highest derivative of the Taylor series, 1 to 8"},
            {"projection", "monomials",
             "monomials | in 1D two of constant, linear, quadratic, cubic, as linear+quadratic"}}},
          in_every_dimension<Method>([]<int Dim>(Dimension<Dim>, Options& options) {
            const int order = options.integer("order", 1, 8);
            if (options.text("projection") != "monomials") {
              return make_pair_method<Dim>(read_pair(options));
            }
            return make_taylor_method<Dim>("mfpm", order, make_weight("one").made,
                                           lean_surplus(order), default_lean_stencil(Dim, order));
          })};
}

}  // namespace strongpoint
