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
    means.offsets.push_back(means.offsets.back() +
                            static_cast<std::int64_t>(ends.nodes(2 * p).size()));
  }
  means.columns.resize(means.offsets.back());
  means.values.resize(means.offsets.back() * means.per_entry);
  for (int p = 0; p < sites.point_count(); ++p) {
    const std::span<const int> nodes = ends.nodes(2 * p);
    std::copy(nodes.begin(), nodes.end(), means.columns.begin() + means.offsets[p]);
    if (!nodes.empty()) means.row(p) = 0.5 * (ends.row(2 * p) + ends.row(2 * p + 1));
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
