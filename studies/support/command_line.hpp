#pragma once

#include <string>

#include "studies/support/axes.hpp"
#include "studies/support/study.hpp"

namespace strongpoint {

/// What a study program was asked to do.
struct CommandLine {
  enum class Action {
    run,   ///< the case grid
    list,  ///< what there is to choose from
    print  ///< `text`, and nothing else (help, version)
  };
  Action action = Action::run;
  std::string text;
  AxisTexts axes;
  RunOptions run;
  Options extra;                ///< the study's own options
  std::string csv;              ///< file of the table, `-` for standard output, empty for none
  bool prints_readable = true;  ///< no `--csv` was given
  std::string json;             ///< file of the table with its provenance, likewise
  std::string resume;           ///< file whose rows are kept; empty for none
};

/// Reads the arguments of a study program. Throws UsageError that names the option, what was given
/// and what is allowed.
CommandLine parse_command_line(int argc, const char* const* argv, const Study& study);

}  // namespace strongpoint
