#pragma once

#include <string>
#include <vector>

#include "studies/support/axes.hpp"
#include "studies/support/row.hpp"

namespace strongpoint {

/// What an earlier, perhaps interrupted, run of the same study left.
struct Resumed {
  std::vector<std::vector<Row>> cases;  ///< one per planned case, empty where it has to be run
  int left_out = 0;  ///< complete rows of the file that the new table will not hold
};

/// Reads the table at `path`; a file that does not exist or is empty holds no rows. A case is kept
/// when its key and code version match, all expected quantities are there and none failed; in timed
/// studies the number of threads must match too. A last line that was torn off is ignored.
/// Throws UsageError for a file that is not a table of this study.
Resumed read_resumed(const std::string& path, const std::vector<PlannedCase>& plan,
                     const Study& study, int threads, const std::string& version,
                     const Options& extra);

}  // namespace strongpoint
