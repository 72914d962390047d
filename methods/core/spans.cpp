#include "methods/core/spans.hpp"

#include <algorithm>

namespace strongpoint {
namespace {

/// Sites with the ends of all spans in place of the points: those of point p are 2 p and 2 p + 1.
template <int Dim>
Sites<Dim> with_ends(const Sites<Dim>& sites) {
  Sites<Dim> ends = sites;
  ends.spans.resize(Dim, 0);
  ends.points.resize(Dim, 2 * sites.points.cols());
  ends.point_anchor.clear();
  for (int p = 0; p < sites.point_count(); ++p) {
    ends.points.col(2 * p) = sites.points.col(p) + sites.spans.col(p);
    ends.points.col(2 * p + 1) = sites.points.col(p) - sites.spans.col(p);
    ends.point_anchor.insert(ends.point_anchor.end(), 2, sites.point_anchor[p]);
  }
  return ends;
}

/// Appends a row with the nodes of two: a method may leave out nodes that weigh nothing at one end.
void append_union(std::span<const int> a, std::span<const int> b, Weights& weights) {
  const auto first = static_cast<std::ptrdiff_t>(weights.columns.size());
  weights.columns.insert(weights.columns.end(), a.begin(), a.end());
  const bool is_same = std::equal(a.begin(), a.end(), b.begin(), b.end());
  for (std::size_t j = 0; j < b.size() && !is_same; ++j) {
    const auto row = weights.columns.begin() + first;
    if (std::find(row, weights.columns.end(), b[j]) == weights.columns.end()) {
      weights.columns.push_back(b[j]);
    }
  }
  weights.offsets.push_back(static_cast<std::int64_t>(weights.columns.size()));
}

/// Adds half of a row to row p of `means`, which has all of its nodes.
void add_half(const Weights& ends, int end, int p, Weights& means) {
  const std::span<const int> nodes = means.nodes(p);
  Eigen::Map<Eigen::MatrixXd> sum = means.row(p);
  for (std::size_t j = 0; j < ends.nodes(end).size(); ++j) {
    const int node = ends.nodes(end)[j];
    const bool is_there = nodes[j] == node;  // as in all rows of most methods
    const auto place = is_there ? nodes.begin() + static_cast<std::ptrdiff_t>(j)
                                : std::find(nodes.begin(), nodes.end(), node);
    sum.col(place - nodes.begin()) += 0.5 * ends.row(end).col(static_cast<Eigen::Index>(j));
  }
}

}  // namespace

template <int Dim>
Weights weights_on(const Method<Dim>& method, const Sites<Dim>& sites, const Stencils& stencils,
                   const Derivatives<Dim>& derivatives) {
  if (sites.spans.cols() == 0 || method.reads_spans()) {
    return method.weights(sites, stencils, derivatives);
  }
  const Weights ends = method.weights(with_ends(sites), stencils, derivatives);
  Weights means;
  means.per_entry = ends.per_entry;
  for (int p = 0; p < sites.point_count(); ++p) {
    append_union(ends.nodes(2 * p), ends.nodes(2 * p + 1), means);
  }
  means.values.resize(means.columns.size() * means.per_entry);
  std::fill(means.values.begin(), means.values.end(), 0.0);
#pragma omp parallel for schedule(static)
  for (int p = 0; p < sites.point_count(); ++p) {
    for (const int end : {2 * p, 2 * p + 1}) add_half(ends, end, p, means);
  }
  return means;
}

template Weights weights_on(const Method<1>&, const Sites<1>&, const Stencils&,
                            const Derivatives<1>&);
template Weights weights_on(const Method<2>&, const Sites<2>&, const Stencils&,
                            const Derivatives<2>&);
template Weights weights_on(const Method<3>&, const Sites<3>&, const Stencils&,
                            const Derivatives<3>&);

}  // namespace strongpoint
