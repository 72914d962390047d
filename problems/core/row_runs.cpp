#include "problems/core/row_runs.hpp"

#include <algorithm>

namespace strongpoint {

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

bool RowRuns::are_unknowns(std::span<const int> nodes) const {
  return std::all_of(nodes.begin(), nodes.end(),
                     [&](int node) { return sources_.unknowns.of(node) == node; });
}

/// True when the rows of a point have the known terms, and its nodes are few enough and unknowns
/// themselves.
template <int Fields>
bool RowRuns::is_alike(const EquationPlace* places) const {
  const int point = places[0].point;
  bool is_one_point = point != own_points;
  for (int r = 0; r < Fields; ++r) {
    if (places[r].first != known_[r]) return false;
    is_one_point = is_one_point && places[r].point == point;
  }
  if (!is_one_point) return false;
  const std::span<const int> nodes = sources_.weights.nodes(point);
  if (nodes.empty() || nodes.size() > most_kernel_nodes) return false;
  return sources_.unknowns.is_identity() || are_unknowns(nodes);
}

template <int Fields>
int RowRuns::count_alike(int row, int end) const {
  const EquationPlace* places = sources_.equations.places.data() + row;
  int points = 0;
  for (; row + Fields <= end && is_alike<Fields>(places); row += Fields, ++points) places += Fields;
  return points;
}

int RowRuns::find(int row, int end) {
  const int fields = sources_.fields;
  if (fields > most_kernel_fields || sources_.weights.per_entry > most_kernel_derivatives) return 0;
  if (row + fields > end) return 0;
  const EquationPlace* const places = sources_.equations.places.data() + row;
  for (int r = 0; r < fields; ++r) {
    // Rows without terms share the place of the next one, but name no point.
    if (places[r].point == own_points) return 0;
    if (places[r].first != known_[r]) {
      learn(row);
      break;
    }
  }
  if (!is_usable_) return 0;
  switch (fields) {
    case 1:
      return count_alike<1>(row, end);
    case 2:
      return count_alike<2>(row, end);
    default:
      return count_alike<3>(row, end);
  }
}

}  // namespace strongpoint
