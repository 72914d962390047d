#pragma once

#include <cstdint>

/// Stencils of one size in the plane, and where their weights go.
struct RbfRivalTask {
  int size;             ///< n, 15 or 30
  int degree;           ///< of the polynomials, 2 with 15 nodes and 4 with 30
  int count;            ///< of the nodes, each of which has a stencil
  const double* nodes;  ///< (2, count) coordinates
  const int* ids;       ///< (n, count) stencils, each node's own first
  double* values;       ///< (5, n, count) weights of dx, dy, dxx, dxy, dyy
};

/// RBF-FD weights of r^3 as one writes them with Eigen: the bordered matrix of a stencil, in units
/// of its radius, PartialPivLU, all derivatives at once. The library is built for the processor at
/// hand and shares no code with the rest.
extern "C" __attribute__((visibility("default"))) void rbf_rival_weights(const RbfRivalTask* task);
