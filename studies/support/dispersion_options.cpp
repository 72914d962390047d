#include "studies/support/dispersion_options.hpp"

#include <algorithm>
#include <charconv>
#include <string_view>

#include <fmt/format.h>

#include "methods/core/error.hpp"
#include "problems/core/integrator.hpp"

namespace strongpoint {
namespace {

constexpr const char* exact_in_time = "exact";

std::vector<double> parse_waves(const std::string& text) {
  std::vector<double> waves;
  for (std::size_t start = 0; start <= text.size();) {
    const std::size_t end = std::min(text.find(',', start), text.size());
    const std::string_view part = std::string_view(text).substr(start, end - start);
    double wave = 0;
    const auto [stop, error] = std::from_chars(part.data(), part.data() + part.size(), wave);
    const bool is_read = error == std::errc() && stop == part.data() + part.size();
    if (!is_read || !(wave > 0 && wave <= 1)) {
      throw UsageError(fmt::format(
          "'{}' is not allowed; give wavenumbers times the spacing over pi, above 0 and up to 1, "
          "such as 0.1,0.5,1",
          part));
    }
    if (std::find(waves.begin(), waves.end(), wave) == waves.end()) waves.push_back(wave);
    start = end + 1;
  }
  return waves;
}

void read_time(const std::string& text, DispersionOptions& options) {
  if (text == exact_in_time) {
    options.time = text;
    return;
  }
  const TimeSpec time = parse_time(text);
  if (!time.spec.starts_with("central")) {
    throw UsageError(
        fmt::format("waves are followed with `{}` and with central differences, as in "
                    "central[dt=1e-5] or central[courant=0.5]",
                    exact_in_time));
  }
  options.time = time.spec;
  options.dt = time.dt;
  options.courant = time.courant;
}

/// The columns that hold the options in force.
std::vector<std::string> option_texts(const DispersionOptions& options) {
  return {options.time, fmt::format("{}", options.directions), fmt::format("{}", options.nodes)};
}

}  // namespace

std::vector<OptionDoc> dispersion_option_docs() {
  return {{"waves", "0.1,0.3,0.5,0.7,1",
           "wavenumbers times the spacing over pi, above 0 and up to 1, at which velocities are "
           "told"},
          {"directions", "12",
           "angles on a half-turn that waves run at, in 3D both of azimuth and of elevation, 1 to "
           "360"},
          {"nodes", "1",
           "inner nodes nearest to the middle of the domain whose symbols are taken, 1 to 10000: "
           "value is the median, low and high are the smallest and largest"},
          {"time", "central[dt=1e-5]",
           "exact | central[dt=...|courant=...]: how waves advance in time"}};
}

DispersionOptions dispersion_options(const Options& extra) {
  DispersionOptions options;
  options.waves = parse_waves(extra.text("waves"));
  options.directions = extra.integer("directions", 1, 360);
  options.nodes = extra.integer("nodes", 1, 10'000);
  read_time(extra.text("time"), options);
  return options;
}

std::string wave_text(double wave) { return fmt::format("{:.6g}", wave); }

std::vector<std::string> dispersion_columns() {
  return {"wave", "direction", "branch", "low", "high", "time", "directions", "sampled"};
}

std::vector<std::string> dispersion_texts(const WaveTexts& wave, const std::string& low,
                                          const std::string& high,
                                          const DispersionOptions& options) {
  std::vector<std::string> texts{wave.wave, wave.direction, wave.branch, low, high};
  for (const std::string& text : option_texts(options)) texts.push_back(text);
  return texts;
}

bool keeps_dispersion_row(const std::vector<std::string>& columns,
                          const DispersionOptions& options) {
  const std::vector<std::string> texts = option_texts(options);
  if (columns[0].empty() && columns[2].empty()) return true;  // a skipped case
  if (!std::equal(texts.begin(), texts.end(), columns.end() - 3)) return false;
  const bool has_asked_wave = columns[2] != every_branch && !columns[0].empty();
  return !has_asked_wave || std::any_of(options.waves.begin(), options.waves.end(),
                                        [&](double wave) { return wave_text(wave) == columns[0]; });
}

}  // namespace strongpoint
