#include "problems/core/equation.hpp"

namespace strongpoint {

void EquationList::end_row(double right_hand_side, double inertia_factor) {
  const auto count = static_cast<int>(static_cast<std::int64_t>(terms.size()) - begin_);
  EquationPlace place{begin_, count, count > 0 ? terms[begin_].point : own_points};
  for (int t = 1; t < count; ++t) {
    if (terms[begin_ + t].point != place.point) place.point = own_points;
  }
  if (place.point != own_points) {
    if (const EquationPlace* alike = find_alike(count)) {
      place.first = alike->first;
      terms.resize(begin_);
    } else {
      recent_[next_recent_] = place;
      next_recent_ = (next_recent_ + 1) % remembered;
    }
  }
  begin_ = static_cast<std::int64_t>(terms.size());
  places.push_back(place);
  if (inertia_factor != 0 && inertia.empty()) inertia.assign(right_hand_sides.size(), 0.0);
  right_hand_sides.push_back(right_hand_side);
  if (inertia_factor != 0 || !inertia.empty()) inertia.push_back(inertia_factor);
}

bool EquationList::is_alike(const EquationPlace& place, int count) const {
  if (place.count != count) return false;
  const Term* const a = terms.data() + place.first;
  const Term* const b = terms.data() + begin_;
  for (int t = 0; t < count; ++t) {
    if (a[t].coefficient != b[t].coefficient || a[t].field != b[t].field ||
        a[t].derivative != b[t].derivative) {
      return false;
    }
  }
  return true;
}

const EquationPlace* EquationList::find_alike(int count) {
  for (int tried = 0; tried < remembered; ++tried) {
    const int at = (guess_ + tried) % remembered;
    if (!is_alike(recent_[at], count)) continue;
    guess_ = (at + 1) % remembered;
    return &recent_[at];
  }
  return nullptr;
}

void EquationList::clear() {
  places.clear();
  terms.clear();
  right_hand_sides.clear();
  inertia.clear();
  row_weights.clear();
  begin_ = 0;
  recent_.fill({});
  next_recent_ = 0;
  guess_ = 0;
}

void EquationList::reserve(int rows) {
  places.reserve(rows);
  right_hand_sides.reserve(rows);
}

}  // namespace strongpoint
