#pragma once

#include "methods/core/simd/path.hpp"

namespace strongpoint {

/// Queries of a group at most.
inline constexpr int group_size = 16;

/// Stencils of up to this size are found by `nearest_of_group`.
inline constexpr int group_k_max = 96;

/// What became of a query of a group.
enum class GroupOutcome {
  found,      ///< its row is written
  ambiguous,  ///< distances too close to tell their order
  few,        ///< less than k nodes are sure to be known
  many        ///< more nodes than there is room for
};

/// Room for a group's work, kept from group to group.
struct GroupRoom {
  static constexpr int survivors = 128;       ///< nodes of a query that are sorted at most
  float squares[group_size][survivors + 32];  ///< their squared distances over reach^2
  int ids[group_size][survivors + 32];        ///< their node ids
  int found[group_size];                      ///< how many of them
  int sorted[group_size][survivors];          ///< ids by distance, of ambiguous queries
  int candidates[group_size];                 ///< of those, how many may be wanted
  GroupOutcome outcome[group_size];
  float limit;  ///< square over reach^2 that the next query should take
  int retries;  ///< queries with less than k nodes within the limit
};

/// The k nodes nearest to each of some queries (or, where bounds are given, candidates for the
/// nodes within them, all ambiguous) that lie together. Everything within `reach` of the
/// box around them is listed once, in single precision about the middle of the box, and each query
/// sorts what lies within a limit
/// that follows the number of nodes which the last query found there. The order is certified: where
/// distances (or the k-th and what follows) differ by less than the error bound the query is left
/// to the caller as ambiguous.
struct NearestGroup {
  int dim;
  int k;                     ///< at most `group_k_max` and the number of nodes
  const double* nodes[3];    ///< (N) coordinates of the nodes, with 8 entries of padding behind
  const int* ids;            ///< (N) their ids, padded alike
  const int* ranges;         ///< (2 range_count) begin and end of the nodes to be looked at
  int range_count;           ///< which include all within `reach` of the box
  const double* queries[3];  ///< (query_count) coordinates
  int query_count;           ///< at most `group_size`
  int* const* rows;          ///< (query_count) where k ids are put
  double middle[3];          ///< of the box around the queries
  double half[3];            ///< its half widths
  double reach;              ///< of the list, positive
  float limit;               ///< squared distance over reach^2 to begin with, at most 1
  float target;              ///< nodes that should lie within the limit
  float gain;                ///< how fast the limit follows
  const double* bounds;      ///< (query_count) squared radii; null: the k nearest are wanted
  float* list[3];            ///< room for all nodes of the ranges and 16 more, each
  int* list_ids;             ///< likewise
  GroupRoom* room;
};

STRONGPOINT_SIMD_KERNEL(nearest_of_group, NearestGroup);

/// Sorts the candidates of ambiguous queries by (distance, node id), the distances as exact as
/// `squared_distance` has them, and sets their number to k and what ties with the k-th.
struct ExactOrder {
  int dim;
  int k;
  const double* nodes;       ///< (Dim, N) coordinates, node after node
  const double* queries[3];  ///< (query_count) coordinates
  int query_count;
  const double* bounds;  ///< (query_count) squared distances up to which nodes are kept; null: k
  double tie_factor;     ///< bound of ties over the k-th squared distance; 1: ties are cut
  GroupRoom* room;
};

STRONGPOINT_SIMD_KERNEL(order_exactly, ExactOrder);

}  // namespace strongpoint
