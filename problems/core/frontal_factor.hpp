#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "methods/core/large_array.hpp"
#include "problems/core/node_graph.hpp"

namespace strongpoint {

/// LU factors of a square sparse matrix by the frontal method: nodes are eliminated some at a time
/// in a dense front that sweeps over the graph, with pivots chosen among the rows of these nodes
/// alone, so that the caller has to judge the residual. For plane problems of up to some thousand
/// nodes with wide stencils, whose fronts fit into the processor's cache. Source: Irons 1970, A
/// frontal solution program. In single precision factors take half the time and memory, and serve
/// corrections by residuals that are made in double precision.
template <class Real>
class FrontalFactor {
 public:
  /// Factorises a matrix with `fields` unknowns in turn for each node of its graph, in the order
  /// given (all nodes).
  FrontalFactor(const Eigen::Map<const RowMatrix>& matrix, int fields, const NodeGraph& graph,
                std::span<const int> order);

  /// False when a pivot was zero or not a number, or the factors would take more than 4 GB; there
  /// are none then.
  bool has_factors() const { return has_factors_; }
  /// Solves A x = b, n numbers each, to the precision of the factors; `x` may be `b`. To be called
  /// with factors alone.
  void solve(const double* b, double* x) const;
  /// Memory of the factors and the front.
  std::size_t bytes() const { return (factors_.size() + front_size_) * sizeof(Real); }

 private:
  /// Nodes eliminated together.
  struct Step {
    int begin, end;        ///< of the nodes in the order
    int rest;              ///< unknowns that stay in the front
    std::size_t unknowns;  ///< where those that stay begin in `fronts_`, then the pivots'
    std::size_t block;     ///< where the factors of the pivots begin in `factors_`, then the panels
                           ///< of rows and of columns beside them
  };
  class Front;

  int fields_;
  bool has_factors_ = true;
  std::size_t front_size_ = 0;
  std::vector<Step> steps_;
  std::vector<int> fronts_;  ///< unknowns that stay in each step's front, by place, then its pivots
  std::vector<int> swapped_;  ///< (n) rows that changed places within a step
  LargeArray<Real> factors_;
  int longest_ = 0;  ///< most unknowns that stay in a front, rounded up to tiles

  int pivots_of(const Step& step) const { return (step.end - step.begin) * fields_; }
  /// Where the panel of rows begins behind a block, and that of columns.
  std::size_t upper_of(const Step& step) const {
    return static_cast<std::size_t>(pivots_of(step)) * pivots_of(step);
  }
  std::size_t lower_of(const Step& step) const;
};

extern template class FrontalFactor<double>;
extern template class FrontalFactor<float>;

}  // namespace strongpoint
