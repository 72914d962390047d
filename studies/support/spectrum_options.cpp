#include <algorithm>
#include <sstream>

#include "problems/core/integrator.hpp"
#include "studies/support/spectrum_case.hpp"

namespace strongpoint {
namespace {

constexpr const char* all_modes = "all";

/// Shares in per cent, separated by commas.
std::vector<double> read_shares(const std::string& text) {
  std::vector<double> shares;
  std::istringstream stream(text + ",");
  for (std::string part; std::getline(stream, part, ',');) {
    std::size_t end = 0;
    double percent = 0;
    try {
      percent = std::stod(part, &end);
    } catch (const std::exception&) {
      end = 0;
    }
    if (end == 0 || end != part.size() || !(percent > 0 && percent <= 100)) {
      throw UsageError(fmt::format(
          "'{}' is no share of the modes; give per cents above 0 to 100, as 5,50,100, or all",
          part));
    }
    shares.push_back(percent / 100);
  }
  return shares;
}

}  // namespace

std::vector<OptionDoc> spectrum_option_docs() {
  return {{"engine", "auto",
           fmt::format("auto | dense | spectra: all eigenvalues, or a few of them; auto is dense "
                       "up to {} unknowns",
                       dense_limit)},
          {"modes", "5,10,25,50,75,100",
           "modes judged where they are known: shares of their number in per cent, or all"},
          {"time", "central", "how steps are taken, as central[courant=0.5]"},
          {"damping", "none", "none, stiffness[eta=0.02], hyper[g=0.02]"}};
}

SpectrumOptions spectrum_options(const Options& extra) {
  using Engine = SpectrumOptions::Engine;
  SpectrumOptions options;
  options.engine = extra.choice<Engine>(
      "engine",
      {{"auto", Engine::automatic}, {"dense", Engine::dense}, {"spectra", Engine::spectra}});
  options.modes = extra.text("modes");
  if (options.modes != all_modes) {
    options.shares = read_shares(options.modes);
    options.modes.clear();
    for (const double share : options.shares) {
      options.modes += fmt::format("{}{:.10g}", options.modes.empty() ? "" : " ", 100 * share);
    }
  }
  options.time = parse_time(extra.text("time")).spec;
  options.damping = canonical_damping(extra.text("damping"));
  return options;
}

std::vector<std::string> spectrum_columns() {
  return {"engine", "time", "damping", "modes", "share", "mode"};
}

bool same_options(const std::vector<std::string>& columns, const SpectrumOptions& options) {
  using Engine = SpectrumOptions::Engine;
  const bool same_engine = options.engine == Engine::automatic || columns[0].empty() ||
                           columns[0] == (options.engine == Engine::dense ? "dense" : "spectra");
  return same_engine && columns[1] == options.time && columns[2] == options.damping &&
         columns[3] == options.modes;
}

}  // namespace strongpoint
