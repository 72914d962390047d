#pragma once

namespace strongpoint {

/// A node that may join a stencil; ordered by (distance, node id), as stencils are.
struct Candidate {
  double squared_distance;
  int node;

  // Written out, since distances are never NaN: a three-way comparison would provide for it.
  bool operator<(const Candidate& other) const {
    return squared_distance < other.squared_distance ||
           (squared_distance == other.squared_distance && node < other.node);
  }
};

}  // namespace strongpoint
