#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "methods/core/points.hpp"
#include "methods/core/stencils.hpp"

namespace strongpoint {

/// Whether nodes as far away as the last one join the stencil. Distances tie within 1e-9, relative.
enum class Ties { keep, cut };

/// Relative difference of two distances that count as equal.
inline constexpr double tie_tolerance = 1e-9;

/// Neighbour search over a fixed set of nodes. Results are exact, sorted by (distance, node id),
/// and the same for every engine and number of threads.
template <int Dim>
class NeighbourSearch {
 public:
  NeighbourSearch() = default;
  NeighbourSearch(const NeighbourSearch&) = delete;
  NeighbourSearch& operator=(const NeighbourSearch&) = delete;
  virtual ~NeighbourSearch() = default;

  /// The `k` nodes nearest to each query (a column), a node at the query included. With fewer than
  /// `k` nodes in the cloud all of them are returned. Throws CaseError for a query that is not
  /// finite and std::invalid_argument for k < 1.
  virtual Stencils nearest(const Points<Dim>& queries, int k, Ties ties) const = 0;
  /// All nodes within a radius of each query, the bound included. Throws like `nearest`, and for
  /// radii that are NaN or not one per query.
  virtual Stencils within(const Points<Dim>& queries, std::span<const double> radii) const = 0;
};

/// Names of the engines that `make_search` knows, `auto` first.
const std::vector<std::string>& search_engines();

/// Builds an engine on the nodes, which must outlive it. Throws UsageError for an unknown name and
/// CaseError for a coordinate that is not finite or beyond 1e150.
template <int Dim>
std::unique_ptr<NeighbourSearch<Dim>> make_search(std::string_view engine,
                                                  const Points<Dim>& nodes);

/// The columns of `points` named by `ids`.
template <int Dim>
Points<Dim> columns_of(const Points<Dim>& points, std::span<const int> ids) {
  Points<Dim> chosen(Dim, static_cast<Eigen::Index>(ids.size()));
  for (std::size_t i = 0; i < ids.size(); ++i) {
    chosen.col(static_cast<Eigen::Index>(i)) = points.col(ids[i]);
  }
  return chosen;
}

}  // namespace strongpoint
