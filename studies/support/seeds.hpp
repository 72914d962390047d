#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "studies/support/study.hpp"

namespace strongpoint {

/// The same cloud spec with `count` consecutive seeds, its own (or `seed`, where it gives none) the
/// first; the spec alone for a layout without random numbers. Throws UsageError when the last seed
/// is larger than layouts take.
std::vector<std::string> with_seeds(const std::string& cloud, std::uint64_t seed, int count);

/// Joins results of one case on clouds of several seeds: per quantity the median of those that have
/// a value, with the extra texts {number of values, smallest, largest}, shortest digits that read
/// back. Nodes and spacing are the first result's.
CaseResult median_of(const std::vector<CaseResult>& results);

}  // namespace strongpoint
