#pragma once

#include <string>
#include <vector>

#include "studies/support/row.hpp"

namespace strongpoint {

/// Writes into extra column `column` of every row the exponent p with which its quantity grows,
/// value ~ nodes^p: the least-squares slope over all levels of the same choice, where there are two
/// values above zero at least.
void fit_exponents(std::vector<std::vector<Row>>& cases, std::size_t column);

/// A line per choice and quantity: value per node on the last level, and the exponent. Extra
/// columns 0 and 1 hold them.
std::string exponents_text(const std::vector<std::vector<Row>>& cases);

}  // namespace strongpoint
