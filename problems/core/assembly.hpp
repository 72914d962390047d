#pragma once

#include "methods/core/weights.hpp"
#include "problems/core/equation.hpp"
#include "problems/core/solvers.hpp"
#include "problems/core/unknowns.hpp"

namespace strongpoint {

/// Writes the rows of `equations` straight into compressed rows: unknown = node * fields + field,
/// where columns of nodes that are no unknowns become those of the unknowns they stand for. Each
/// row is scaled to a largest entry of 1, then by its weight. There are as many rows as unknowns,
/// or more for a least-squares solution. A term on the bare value (`value_only`) at point p
/// is the unknown of node p. Cost: one pass to size the rows, one to fill them, in parallel, no
/// triplets. Throws CaseError for a row without entries, for an entry that is not finite, and for a
/// derivative read at a point without weights, naming the row and where its first term is taken.
LinearSystem assemble(const EquationList& equations, const Weights& weights,
                      const NodeUnknowns& unknowns, int fields);

/// Puts other equations, or other weights, with the same pattern into a system made by `assemble`:
/// new values, right-hand sides and scales, the columns stay. Gives the same bits as `assemble`.
/// Throws as that does, and CaseError when a row has other columns or their number is another, the
/// system then being good for nothing.
void reassemble(const EquationList& equations, const Weights& weights, const NodeUnknowns& unknowns,
                LinearSystem& system);

}  // namespace strongpoint
