#pragma once

#include <optional>
#include <string>
#include <vector>

#include "methods/core/options.hpp"
#include "studies/support/study.hpp"

namespace strongpoint {

/// How a case runs in time.
struct TimeOptions {
  std::string time;              ///< canonical spec of the integrator; empty: central differences
  std::optional<double> t_end;   ///< when the solution is judged; the problem's own if not given
  std::string damping = "none";  ///< canonical spec
  std::optional<double> noise;   ///< how long noise runs to measure its growth; none: it is not
  int frames = 1;                ///< how many instants are written for ParaView, the end among them
  std::string checkpoints;       ///< directory of the files of runs under way; empty: none
  double checkpoint_seconds = 5;  ///< between two states saved

  /// The spec of the integrator that is used.
  std::string integrator() const { return time.empty() ? "central" : time; }
};

/// The options of a study that runs problems in time.
std::vector<OptionDoc> time_option_docs();

/// Reads them. Throws UsageError for values that do not fit.
TimeOptions time_options(const Options& extra);

/// Makes the directory of checkpoints. Throws UsageError when files cannot be written there, and
/// for frames without `--vtk`.
void prepare_time(const Options& extra, const RunOptions& run);

/// Names of the columns that tell how a case ran in time: `time` (the integrator), `t_end`,
/// `damping`, `dt`, `steps` and `noise` (how long noise ran, empty if it did not).
std::vector<std::string> time_columns();

/// Whether a row of a table that is resumed, by its case and those columns, was computed with these
/// options.
bool keeps_time(const CaseKey& key, const std::vector<std::string>& columns, const Options& extra);

}  // namespace strongpoint
