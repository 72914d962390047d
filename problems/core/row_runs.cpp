#include "problems/core/row_runs.hpp"

#include <algorithm>

namespace strongpoint {

bool RowRuns::is_known(const EquationPlace* places) const {
  for (int r = 0; r < sources_.fields; ++r) {
    if (places[r].first != known_[r]) return false;
  }
  return true;
}

bool RowRuns::is_at_one_point(const EquationPlace* places) const {
  for (int r = 0; r < sources_.fields; ++r) {
    if (places[r].point == own_points || places[r].point != places[0].point) return false;
  }
  return true;
}

/// True when the nodes of a point are few enough and unknowns themselves.
bool RowRuns::has_usable_nodes(int point) const {
  const std::span<const int> nodes = sources_.weights.nodes(point);
  if (nodes.empty() || nodes.size() > most_kernel_nodes) return false;
  return sources_.unknowns.is_identity() || std::all_of(nodes.begin(), nodes.end(), [&](int node) {
           return sources_.unknowns.of(node) == node;
         });
}

/// Takes the coefficients from the rows of a point.
void RowRuns::learn(int row) {
  const int fields = sources_.fields;
  coefficients_.assign(static_cast<std::size_t>(sources_.weights.per_entry) * fields * fields, 0.0);
  is_usable_ = true;
  for (int r = 0; r < fields; ++r) {
    known_[r] = sources_.equations.places[row + r].first;
    std::array<bool, most_kernel_fields> occurs{};
    for (const Term& term : sources_.equations.row(row + r)) {
      if (term.derivative == value_only) {
        is_usable_ = false;
        return;
      }
      occurs[term.field] = true;
      coefficients_[(term.derivative * fields + r) * fields + term.field] += term.coefficient;
    }
    is_usable_ = is_usable_ && std::all_of(occurs.begin(), occurs.begin() + fields,
                                           [](bool does) { return does; });
  }
}

int RowRuns::find(int row, int end) {
  const int fields = sources_.fields;
  points_.clear();
  if (fields > most_kernel_fields || sources_.weights.per_entry > most_kernel_derivatives) return 0;
  for (; row + fields <= end; row += fields) {
    const EquationPlace* const places = sources_.equations.places.data() + row;
    if (!is_at_one_point(places) || !has_usable_nodes(places[0].point)) break;
    if (!is_known(places)) {
      if (!points_.empty()) break;
      learn(row);
    }
    if (!is_usable_) break;
    points_.push_back(places[0].point);
  }
  return static_cast<int>(points_.size());
}

}  // namespace strongpoint
