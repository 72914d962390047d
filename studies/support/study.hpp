#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "methods/core/options.hpp"

namespace strongpoint {

struct CaseMonitor;
struct Row;

/// One point of a study's case grid, in canonical specs.
struct CaseKey {
  std::string problem, method, stencil, cloud, form, solver;
  int level = 0;  ///< nodes along the problem's reference side

  bool operator==(const CaseKey&) const = default;
};

/// Where the cases of a study write their nodes with numbers for ParaView.
struct VtkOutput {
  std::string directory;  ///< exists
  std::string study;
};

/// How cases are run, the same for every case of a table.
struct RunOptions {
  std::string neighbours = "auto";
  int threads = 1;
  int repeat = 1;          ///< timed stages take the minimum over this many runs
  std::uint64_t seed = 1;  ///< for clouds whose spec gives none
  std::optional<VtkOutput> vtk;
  CaseMonitor* monitor = nullptr;  ///< null: nobody looks on
};

/// One number of a case. A bad numerical outcome is a value, or no value with a reason; it is not a
/// failure.
struct Quantity {
  std::string name;
  std::optional<double> value;
  std::string reason;
  std::vector<std::string> extra;  ///< one text per extra column of the study
};

/// Seconds spent in each stage, the peak memory of the case and the residual of its linear solve.
struct StageTimes {
  double cloud = 0, prepare = 0, neighbours = 0, stencils = 0, weights = 0, assemble = 0, solve = 0;
  double voronoi = 0;  ///< the part of `prepare` spent on Voronoi cells
  double peak_mb = 0;
  double residual = 0;  ///< of the linear solve, relative, after row scaling

  double total() const {
    return cloud + prepare + neighbours + stencils + weights + assemble + solve;
  }
};

/// What running a case gives.
struct CaseResult {
  std::int64_t nodes = 0;
  std::int64_t unknowns = 0;
  double spacing = 0;  ///< (measure/N)^(1/Dim)
  int iterations = 0;  ///< of the linear solver, 0 when it is direct
  std::string solver;  ///< what solved the system, where the one asked for has a choice
  std::vector<Quantity> quantities;
  StageTimes times;
};

/// The default of each axis, as a user would write it.
struct AxisDefaults {
  std::string problem, method, cloud = "grid", form = "collocation", solver = "umfpack";
  std::string levels = "21,41,81";
  std::string smoke_levels = "9,11";
  std::string smoke_method;  ///< empty: as `method`
};

/// The default of an option of a study that is a flag: it is `flag_on` when given, without a value.
inline constexpr const char* flag_off = "off";
inline constexpr const char* flag_on = "on";

/// A study program: what it is called, what its axes default to, how it runs one case.
struct Study {
  std::string name, summary;
  AxisDefaults defaults;
  bool timed = false;                      ///< adds the timing columns
  bool rated = true;                       ///< fills `rate` from level to level
  std::vector<std::string> unrated;        ///< quantities without a rate: no errors
  bool mapped = false;                     ///< its cases write files for `--vtk`
  std::vector<std::string> extra_columns;  ///< appended after the contract's columns
  /// Extra columns that tell rows of one quantity apart in the readable table, as in `wave=0.1`;
  /// empty: every one that holds a word.
  std::vector<std::string> variant_columns;
  std::vector<OptionDoc> extra_options;  ///< `--key VALUE` options of this study, and flags
  /// Reads the study's own options, to throw UsageError for a value that does not fit before any
  /// file is touched; empty: any value fits.
  std::function<void(const Options& extra)> check_options;
  /// Prepares what all cases need, as directories, before any of them is planned. Throws UsageError
  /// that names its option; empty: nothing.
  std::function<void(const Options& extra, const RunOptions& run)> prepare;
  /// The levels when `--levels` is not given and this is no smoke run; empty: those of `defaults`.
  std::function<std::string(const Options& extra)> default_levels;
  /// The stencil axis when `--stencil` is not given, in specs made from the study's own options,
  /// which are all refused beside `--stencil`. Without it every method is run with its default.
  std::function<std::string(const Options& extra)> default_stencils;
  /// Names of the quantities a case gives, for rows of failed and skipped cases and to tell whether
  /// a case in a resumed file is complete. May throw SkipCase.
  std::function<std::vector<std::string>(const CaseKey&, const Options& extra)> quantities;
  /// Whether a row of a resumed file, by its case and extra columns, was computed with these
  /// options of the study; empty: always.
  std::function<bool(const CaseKey&, const std::vector<std::string>& columns, const Options& extra)>
      keeps;
  /// Runs a case. Throws CaseError (a failed row) or SkipCase (a skipped one).
  std::function<CaseResult(const CaseKey&, const RunOptions&, const Options& extra)> run;
  /// Fills extra columns that take the whole table, in the rows of all cases that have run; empty:
  /// there are none. A table on a stream is then written at the end.
  std::function<void(std::vector<std::vector<Row>>& cases)> conclude;
  /// Text that follows the readable table; empty: none.
  std::function<std::string(const std::vector<std::vector<Row>>& cases)> appendix;
};

/// The whole of a study program: parses the command line, runs the case grid, writes the tables.
/// Returns the exit status: 0 all rows ok or skipped, 1 a case failed or output could not be
/// written, 2 bad arguments.
int run_study(int argc, char** argv, const Study& study);

}  // namespace strongpoint
