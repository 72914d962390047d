#pragma once

#include <optional>
#include <string>
#include <vector>

#include "methods/core/options.hpp"
#include "studies/support/study.hpp"

namespace strongpoint {

/// Which waves are asked about, and at which nodes.
struct DispersionOptions {
  std::vector<double> waves;   ///< |xi| h / pi, each above 0 and up to 1
  int directions = 0;          ///< angles on a half-turn
  int nodes = 0;               ///< nodes nearest to the middle
  std::string time;            ///< `exact`, or a canonical spec of central differences
  std::optional<double> dt{};  ///< of `time`
  std::optional<double> courant{};
};

/// The options of the study, for `--list` and the command line.
std::vector<OptionDoc> dispersion_option_docs();

/// Reads them. Throws UsageError for values that do not fit.
DispersionOptions dispersion_options(const Options& extra);

/// Names of its columns after the contract's: what a row's wave is, `low` and `high` (the smallest
/// and the largest value over the nodes, whose median is the value), and the options in force.
std::vector<std::string> dispersion_columns();

/// What tells a row's wave from others.
struct WaveTexts {
  std::string wave{}, direction{}, branch{};
};

/// Branch of a row that speaks of all waves.
inline constexpr const char* every_branch = "all";

/// |xi| h / pi as the tables tell it.
std::string wave_text(double wave);

/// The texts of a row's extra columns.
std::vector<std::string> dispersion_texts(const WaveTexts& wave, const std::string& low,
                                          const std::string& high,
                                          const DispersionOptions& options);

/// Whether a row of a resumed file, by its extra columns, was computed with these options.
bool keeps_dispersion_row(const std::vector<std::string>& columns,
                          const DispersionOptions& options);

}  // namespace strongpoint
