#pragma once

#include <cstdint>
#include <vector>

#include "problems/core/sparse_factor.hpp"

namespace strongpoint {

/// Unknowns of a square matrix in an order that fills its factors little: nested dissection of the
/// graph of nodes, whose `fields` unknowns are numbered together, with the pattern made symmetric.
/// Empty when the library cannot serve: more than 2^31 couplings, or unknowns that are no multiple
/// of `fields`. Source: Karypis, Kumar 1998, METIS.
std::vector<std::int64_t> node_ordering(const Eigen::Map<const RowMatrix>& matrix, int fields);

}  // namespace strongpoint
