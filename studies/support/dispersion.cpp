#include "studies/support/dispersion.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "methods/core/error.hpp"
#include "methods/core/parallel_errors.hpp"
#include "problems/core/wave_branches.hpp"
#include "studies/support/node_symbols.hpp"
#include "studies/support/seeds.hpp"
#include "studies/support/wave_directions.hpp"

namespace strongpoint {
namespace {

constexpr double pi = std::numbers::pi;
constexpr const char* no_value = "the method gives the wave no value at the node";

/// What is asked of each node's symbol.
template <int Dim>
struct Questions {
  const WaveSymbols<Dim>& symbols;
  const DispersionOptions& options;
  std::vector<Direction<Dim>> directions;
  std::vector<std::string> branches;
  std::optional<double> dt;
  double speed;  ///< of the fastest wave

  /// |xi| of a wave, 1 over length.
  double wavenumber(double wave) const { return wave * pi / symbols.spacing; }
  std::vector<Branch> waves(const NodeSymbol<Dim>& symbol, const Direction<Dim>& direction,
                            double wave) const {
    return strongpoint::branches<Dim>(symbol, symbols.exact, wavenumber(wave) * direction.unit,
                                      direction.unit);
  }
};

/// A number of a row, or why there is none.
Quantity told(std::string name, std::optional<double> value, const std::string& reason,
              const WaveTexts& wave) {
  if (value && !std::isfinite(*value)) value.reset();
  if (value) *value += 0.0;  // no minus before a zero
  return {std::move(name), value, value ? "" : reason, {wave.wave, wave.direction, wave.branch}};
}

/// Velocities and dissipation of one wave.
void append_wave(const std::optional<Branch>& branch, double wavenumber, std::optional<double> dt,
                 const WaveTexts& texts, std::vector<Quantity>& rows) {
  std::optional<double> phase, group, loss;
  std::string reason = no_value;
  if (branch) {
    const Frequency found = frequency(branch->eigenvalue, dt);
    phase = found.omega.real() / branch->exact;
    loss = found.omega.imag() / branch->exact;
    if (found.per_eigenvalue && branch->slope) {
      group = (*found.per_eigenvalue * *branch->slope).real() * wavenumber / branch->exact;
    }
    reason = "the frequency has no derivative here: it is zero, or two waves have become one";
  }
  rows.push_back(told("phase_velocity", phase, reason, texts));
  rows.push_back(told("group_velocity", group, reason, texts));
  rows.push_back(told("dissipation", loss, reason, texts));
}

constexpr double tolerance = 0.01;    ///< of phase velocities
constexpr double most_points = 1000;  ///< a wavelength, that are tried

/// Points per wavelength down to which the phase velocity of a branch errs by the tolerance at
/// most; two, all that nodes can tell, if it never errs by more.
template <int Dim>
std::optional<double> points_needed(const Questions<Dim>& asked, const NodeSymbol<Dim>& symbol,
                                    const Direction<Dim>& direction, std::size_t branch) {
  const auto is_good = [&](double wave) {
    const std::vector<Branch> found = asked.waves(symbol, direction, wave);
    if (found.empty()) return false;
    const double omega = frequency(found[branch].eigenvalue, asked.dt).omega.real();
    return std::abs(omega / found[branch].exact - 1) <= tolerance;
  };
  double good = 2 / most_points;
  if (!is_good(good)) return std::nullopt;
  constexpr double factor = 1.05;
  while (good < 1) {
    double bad = std::min(1.0, factor * good);
    if (is_good(bad)) {
      good = bad;
      continue;
    }
    for (int i = 0; i < 30; ++i) {
      const double middle = (good + bad) / 2;
      (is_good(middle) ? good : bad) = middle;
    }
    break;
  }
  return 2 / good;
}

template <int Dim>
void append_points(const Questions<Dim>& asked, const NodeSymbol<Dim>& symbol,
                   std::vector<Quantity>& rows) {
  const std::string name = "points_per_wavelength";
  const std::string reason =
      fmt::format("the phase velocity errs by more than {:g} % at {:g} points per wavelength",
                  100 * tolerance, most_points);
  const std::size_t count = asked.branches.size();
  std::vector<Quantity> worst(count), best(count);
  for (std::size_t b = 0; b < count; ++b) {
    for (const Direction<Dim>& direction : asked.directions) {
      const std::optional<double> points = points_needed(asked, symbol, direction, b);
      const WaveTexts texts{"", direction.text, asked.branches[b]};
      rows.push_back(told(name, points, reason, texts));
      const double size = points.value_or(2 * most_points);  // none is the worst of all
      const bool is_first = worst[b].name.empty();
      if (is_first || size > worst[b].value.value_or(2 * most_points)) {
        worst[b] = told(name + "_worst", points, reason, texts);
      }
      if (is_first || size < best[b].value.value_or(2 * most_points)) {
        best[b] = told(name + "_best", points, reason, texts);
      }
    }
  }
  for (std::size_t b = 0; b < count; ++b) {
    rows.push_back(worst[b]);
    rows.push_back(best[b]);
  }
}

template <int Dim>
void append_extremes(const Questions<Dim>& asked, const NodeSymbol<Dim>& symbol,
                     std::vector<Quantity>& rows) {
  const double h = asked.symbols.spacing;
  double growth = 0;
  double radius = 0;
  bool is_bounded = true;
  WaveTexts growing{"", "", every_branch};
  WaveTexts fastest = growing;
  for_each_wave_vector<Dim>(h, [&](const Point<Dim>& xi) {
    const auto texts = [&] {
      return WaveTexts{wave_text(xi.norm() * h / pi), direction_text<Dim>(xi), every_branch};
    };
    const auto found = eigenvalues<Dim>(symbol, xi);
    is_bounded = is_bounded && !found.empty();
    for (const std::complex<double>& eigenvalue : found) {
      const double rate = std::abs(frequency(eigenvalue, {}).omega.imag());
      constexpr double tie = 1 + 1e-9;  // round-off does not choose among waves alike
      if (rate > growth * tie) growing = texts();
      if (std::abs(eigenvalue) > radius * tie) fastest = texts();
      growth = std::max(growth, rate);
      radius = std::max(radius, std::abs(eigenvalue));
    }
  });
  const auto bounded = [&](double value) {
    return is_bounded ? std::optional<double>(value) : std::nullopt;
  };
  const double scaled = radius * h * h / (asked.speed * asked.speed);
  rows.push_back(told("symbol_growth", bounded(growth), no_value, growing));
  rows.push_back(told("symbol_radius", bounded(scaled), no_value, fastest));
  rows.push_back(told("stable_courant", bounded(2 / std::sqrt(scaled)), no_value, fastest));
}

/// All rows of one node.
template <int Dim>
CaseResult rows_of(const Questions<Dim>& asked, const NodeSymbol<Dim>& symbol) {
  CaseResult result;
  for (const double wave : asked.options.waves) {
    for (const Direction<Dim>& direction : asked.directions) {
      const std::vector<Branch> found = asked.waves(symbol, direction, wave);
      for (std::size_t b = 0; b < asked.branches.size(); ++b) {
        append_wave(found.empty() ? std::nullopt : std::optional<Branch>(found[b]),
                    asked.wavenumber(wave), asked.dt,
                    {wave_text(wave), direction.text, asked.branches[b]}, result.quantities);
      }
    }
  }
  append_points(asked, symbol, result.quantities);
  append_extremes(asked, symbol, result.quantities);
  return result;
}

/// The node whose value is largest; the first where none has one.
const Quantity& largest(const std::vector<CaseResult>& nodes, std::size_t row) {
  const Quantity* best = &nodes.front().quantities[row];
  for (const CaseResult& node : nodes) {
    const Quantity& one = node.quantities[row];
    if (one.value && (!best->value || *one.value > *best->value)) best = &one;
  }
  return *best;
}

/// Medians over the nodes; waves that differ from node to node are those of the largest value.
CaseResult joined(const std::vector<CaseResult>& nodes, const DispersionOptions& options) {
  CaseResult result = median_of(nodes);
  for (std::size_t row = 0; row < result.quantities.size(); ++row) {
    Quantity& quantity = result.quantities[row];
    const std::vector<std::string> spread = quantity.extra;  // count, low, high
    const std::vector<std::string> texts = largest(nodes, row).extra;
    if (quantity.value && spread[0] != fmt::format("{}", nodes.size())) {
      quantity.reason = fmt::format("{} of {} nodes have a value", spread[0], nodes.size());
    }
    quantity.extra =
        dispersion_texts({texts[0], texts[1], texts[2]}, spread[1], spread[2], options);
  }
  return result;
}

template <int Dim>
CaseResult run(const TransientProblem<Dim>& problem, const CaseKey& key, const RunOptions& options,
               const DispersionOptions& dispersion) {
  const WaveSymbols<Dim> symbols = node_symbols<Dim>(problem, key, dispersion.nodes, options);
  Questions<Dim> asked{symbols,
                       dispersion,
                       directions_of<Dim>(dispersion.directions),
                       branch_names(symbols.exact.fields()),
                       {},
                       problem.wave_speed()};
  if (dispersion.time != "exact") {
    asked.dt = dispersion.courant ? *dispersion.courant * symbols.spacing / asked.speed
                                  : dispersion.dt.value_or(problem.time_step());
  }
  std::vector<CaseResult> nodes(symbols.nodes.size());
  ParallelErrors errors;
#pragma omp parallel for schedule(dynamic)
  for (int n = 0; n < static_cast<int>(nodes.size()); ++n) {
    errors.guard(n, [&] { nodes[n] = rows_of<Dim>(asked, symbols.nodes[n]); });
  }
  errors.rethrow();
  CaseResult result = joined(nodes, dispersion);
  result.nodes = symbols.cloud_size;
  result.spacing = symbols.cloud_spacing;
  return result;
}

}  // namespace

std::vector<std::string> dispersion_quantities(const CaseKey& key,
                                               const DispersionOptions& options) {
  return with_problem<TransientProblem>(
      key.problem, "transient", [&]<int Dim>(const TransientProblem<Dim>& problem) {
        const std::size_t branches =
            branch_names(static_cast<int>(problem.space().fields().size())).size();
        const std::size_t rays = directions_of<Dim>(options.directions).size() * branches;
        std::vector<std::string> names;
        for (std::size_t i = 0; i < options.waves.size() * rays; ++i) {
          names.insert(names.end(), {"phase_velocity", "group_velocity", "dissipation"});
        }
        names.insert(names.end(), rays, "points_per_wavelength");
        for (std::size_t b = 0; b < branches; ++b) {
          names.insert(names.end(), {"points_per_wavelength_worst", "points_per_wavelength_best"});
        }
        names.insert(names.end(), {"symbol_growth", "symbol_radius", "stable_courant"});
        return names;
      });
}

CaseResult run_dispersion_case(const CaseKey& key, const RunOptions& options,
                               const DispersionOptions& dispersion) {
  return with_problem<TransientProblem>(key.problem, "transient",
                                        [&]<int Dim>(const TransientProblem<Dim>& problem) {
                                          return run<Dim>(problem, key, options, dispersion);
                                        });
}

}  // namespace strongpoint
