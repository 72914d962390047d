#pragma once

#include <cstdint>

#include "methods/core/weights.hpp"
#include "problems/core/equation.hpp"
#include "problems/core/unknowns.hpp"

namespace strongpoint {

/// What the rows of a system are made of.
struct RowSources {
  const EquationList& equations;
  const Weights& weights;
  const NodeUnknowns& unknowns;
  int fields;

  /// The unknown of a field at a node of the sites.
  std::int64_t column(int node, int field) const {
    return static_cast<std::int64_t>(unknowns.of(node)) * fields + field;
  }
};

}  // namespace strongpoint
