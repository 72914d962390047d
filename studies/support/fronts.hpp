#pragma once

#include <optional>
#include <string>
#include <vector>

#include "studies/support/row.hpp"

namespace strongpoint {

/// Writes "front" into the first extra column of every row that no other row of its problem and
/// quantity beats: none has a smaller value in at most the same total time, or the same value in
/// less. Rows without a value or without times take no part.
void mark_fronts(std::vector<std::vector<Row>>& cases);

/// What one choice of method, stencil, cloud, form and solver took to reach each tolerance.
struct ReachTimes {
  CaseKey key;  ///< level 0
  std::vector<std::optional<double>> seconds;
};

/// The times to reach an error for one problem and quantity.
struct ReachTable {
  std::string problem, quantity;
  std::vector<ReachTimes> choices;  ///< those that reach one tolerance at least, fastest first
};

/// The tolerances of the tables: 1e-2 to 1e-10.
const std::vector<double>& reach_tolerances();

/// The least total time among the levels that were run with at most each tolerance as value; no
/// number is interpolated.
std::vector<ReachTable> reach_tables(const std::vector<std::vector<Row>>& cases);

/// Those tables for a reader's eyes.
std::string reach_text(const std::vector<std::vector<Row>>& cases);

}  // namespace strongpoint
