#pragma once

#include <limits>

#include <nanoflann.hpp>

#include "methods/core/neighbours_collectors.hpp"

namespace strongpoint {

/// A k-d tree by nanoflann: robust for any distribution of nodes.
template <int Dim>
class NanoflannEngine {
 public:
  explicit NanoflannEngine(const Points<Dim>& nodes)
      : nodes_{nodes}, tree_(Dim, nodes_, nanoflann::KDTreeSingleIndexAdaptorParams(leaf_size)) {}

  /// Offers all nodes within the collector's bound.
  template <CandidateCollector Collector>
  void visit(const Point<Dim>& query, Collector& collector) const {
    ResultSet<Collector> results{collector};
    tree_.findNeighbors(results, query.data(), nanoflann::SearchParams());
  }

 private:
  /// Nodes in a leaf: nanoflann's own default.
  static constexpr std::size_t leaf_size = 10;

  /// The nodes as nanoflann reads them; the member names are nanoflann's.
  struct Nodes {
    const Points<Dim>& points;

    std::size_t kdtree_get_point_count() const { return static_cast<std::size_t>(points.cols()); }
    double kdtree_get_pt(std::size_t node, std::size_t component) const {
      return points(static_cast<Eigen::Index>(component), static_cast<Eigen::Index>(node));
    }
    template <class Box>
    bool kdtree_get_bbox(Box&) const {
      return false;
    }
  };

  /// The metric of the tree: the common formula, so that distances need not be computed again.
  struct Metric {
    using ElementType = double;
    using DistanceType = double;
    const Nodes& nodes;

    explicit Metric(const Nodes& n) : nodes(n) {}
    double evalMetric(const double* query, std::size_t node, std::size_t) const {  // NOLINT
      return squared_distance<Dim>(query, nodes.points.col(static_cast<Eigen::Index>(node)));
    }
    double accum_dist(double a, double b, std::size_t) const { return (a - b) * (a - b); }
  };

  /// Hands what the tree finds to a collector; the member names are nanoflann's.
  template <class Collector>
  struct ResultSet {
    Collector& collector;

    bool full() const { return true; }
    std::size_t size() const { return 0; }
    bool addPoint(double d2, int node) {  // NOLINT(readability-identifier-naming)
      if (d2 <= collector.bound()) collector.offer({d2, node});
      return true;
    }
    // The tree wants a strict bound, and its distances to boxes carry round-off.
    double worstDist() const {  // NOLINT(readability-identifier-naming)
      return collector.bound() * (1 + 1e-12) + std::numeric_limits<double>::min();
    }
  };

  Nodes nodes_;
  nanoflann::KDTreeSingleIndexAdaptor<Metric, Nodes, Dim, int> tree_;
};

}  // namespace strongpoint
