#include "methods/core/sites.hpp"

#include <numeric>

namespace strongpoint {

template <int Dim>
std::vector<int> Sites<Dim>::wanted_anchors() const {
  std::vector<int> ids;
  ids.reserve(wanted.size());
  for (int a = 0; a < anchor_count(); ++a) {
    if (wanted[a] != 0) ids.push_back(a);
  }
  return ids;
}

template <int Dim>
Stencils points_by_anchor(const Sites<Dim>& sites) {
  Stencils lists;
  const int count = sites.point_count();
  lists.nodes.resize(sites.point_anchor.size());
  int strays = count - sites.anchor_count();
  for (int p = 0; p < count; ++p) strays |= sites.point_anchor[p] - p;
  if (strays == 0) {  // each anchor is its only point
    std::iota(lists.nodes.begin(), lists.nodes.end(), 0);
    lists.offsets.resize(static_cast<std::size_t>(count) + 1);
    std::iota(lists.offsets.begin(), lists.offsets.end(), std::int64_t{0});
    return lists;
  }
  lists.offsets.assign(sites.anchor_count() + 1, 0);
  for (int anchor : sites.point_anchor) ++lists.offsets[anchor + 1];
  std::partial_sum(lists.offsets.begin(), lists.offsets.end(), lists.offsets.begin());
  auto next = lists.offsets;
  for (int p = 0; p < count; ++p) lists.nodes[next[sites.point_anchor[p]]++] = p;
  return lists;
}

template <int Dim>
Sites<Dim> sites_at_nodes(const Points<Dim>& nodes) {
  Sites<Dim> sites;
  sites.nodes = nodes;
  sites.anchors = nodes;
  sites.points = nodes;
  sites.anchor_node.resize(nodes.cols());
  std::iota(sites.anchor_node.begin(), sites.anchor_node.end(), 0);
  sites.point_anchor = sites.anchor_node;
  sites.anchor_zone.assign(nodes.cols(), Zone::interior);
  sites.wanted.assign(nodes.cols(), 1);
  return sites;
}

template struct Sites<1>;
template struct Sites<2>;
template struct Sites<3>;
template Stencils points_by_anchor(const Sites<1>&);
template Stencils points_by_anchor(const Sites<2>&);
template Stencils points_by_anchor(const Sites<3>&);
template Sites<1> sites_at_nodes(const Points<1>&);
template Sites<2> sites_at_nodes(const Points<2>&);
template Sites<3> sites_at_nodes(const Points<3>&);

}  // namespace strongpoint
