#pragma once

#include <string>
#include <vector>

#include "studies/support/row.hpp"

namespace strongpoint {

/// The table for a reader's eyes: a block per method and stencil under a heading per problem,
/// cloud, form and solver; levels side by side, each value with its rate, and the least-squares
/// slope over all levels. `cases` are in case order.
std::string readable_table(const std::vector<std::vector<Row>>& cases, const Study& study);

}  // namespace strongpoint
