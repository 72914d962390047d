#include "problems/core/crossing_pairs.hpp"

#include <algorithm>
#include <limits>

namespace strongpoint {
namespace {

/// Pairs of which all combinations are tried.
constexpr std::size_t most_pairs = 5;

/// Whether one of the crossings of `other`, and not both, lies between those of `stretch`.
bool are_entangled(const Stretch& stretch, const Stretch& other) {
  const int low = std::min(stretch.leaves, stretch.enters);
  const int high = std::max(stretch.leaves, stretch.enters);
  const bool first = other.leaves > low && other.leaves < high;
  const bool second = other.enters > low && other.enters < high;
  return first != second;
}

bool are_entangled(std::span<const Stretch> stretches) {
  for (std::size_t i = 0; i < stretches.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (are_entangled(stretches[i], stretches[j])) return true;
    }
  }
  return false;
}

/// How well the ends of stretches point at each other, 2 each at most.
double score(std::span<const BoundaryCrossing> crossings, std::span<const Stretch> stretches) {
  double sum = 0;
  for (const Stretch& stretch : stretches) {
    const BoundaryCrossing& from = crossings[stretch.leaves];
    const BoundaryCrossing& to = crossings[stretch.enters];
    const Point<2> chord = to.x - from.x;
    const double length = chord.norm();
    sum += length > 0 ? (from.along + to.along).dot(chord) / length : 2;
  }
  return sum;
}

}  // namespace

void CrossingPairs::find(std::span<const BoundaryCrossing> crossings) {
  const int count = static_cast<int>(crossings.size());
  best_.clear();
  entries_.clear();
  for (int i = 0; i < count; ++i) {
    if (crossings[i].leaves) {
      best_.push_back({i, i + 1 == count ? 0 : i + 1});
    } else {
      entries_.push_back(i);
    }
  }
  if (best_.size() < 2 || best_.size() > most_pairs) return;
  candidate_ = best_;
  double best_score = -std::numeric_limits<double>::infinity();
  do {
    for (std::size_t i = 0; i < entries_.size(); ++i) candidate_[i].enters = entries_[i];
    if (are_entangled(candidate_)) continue;
    const double its_score = score(crossings, candidate_);
    if (its_score <= best_score) continue;
    best_score = its_score;
    best_ = candidate_;
  } while (std::next_permutation(entries_.begin(), entries_.end()));
}

}  // namespace strongpoint
