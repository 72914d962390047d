#include "methods/core/parts.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "methods/core/error.hpp"

namespace strongpoint {
namespace {

/// Where a row of the whole is found.
struct Origin {
  int part = 0;
  int row = 0;
};

/// For every row of the whole the part and the row within it; `ids(part)` lists the part's rows.
template <int Dim, class Ids>
std::vector<Origin> origins(const std::vector<PartSites<Dim>>& parts, const Ids& ids) {
  std::size_t count = 0;
  for (const PartSites<Dim>& part : parts) count += ids(part).size();
  std::vector<Origin> rows(count);
  for (std::size_t p = 0; p < parts.size(); ++p) {
    const std::vector<int>& of_part = ids(parts[p]);
    for (std::size_t i = 0; i < of_part.size(); ++i) {
      rows[of_part[i]] = {static_cast<int>(p), static_cast<int>(i)};
    }
  }
  return rows;
}

void check_length(std::size_t length, int wanted, const char* what) {
  if (length == static_cast<std::size_t>(wanted)) return;
  throw CaseError(fmt::format("the sites name the parts of {} {} but hold {}; give one part each",
                              length, what, wanted));
}

/// Columns of a matrix whose ids are listed.
template <int Dim>
Points<Dim> columns(const Points<Dim>& all, const std::vector<int>& ids) {
  Points<Dim> chosen(Dim, static_cast<Eigen::Index>(ids.size()));
  for (std::size_t i = 0; i < ids.size(); ++i) {
    chosen.col(static_cast<Eigen::Index>(i)) = all.col(ids[i]);
  }
  return chosen;
}

/// Fills the sites of a part whose ids are known. `local_node` gives the id within its part of each
/// node, `local_anchor` of each anchor.
template <int Dim>
void fill_sites(const Sites<Dim>& all, const std::vector<int>& local_node,
                const std::vector<int>& local_anchor, PartSites<Dim>& part) {
  Sites<Dim>& sites = part.sites;
  sites.nodes = columns<Dim>(all.nodes, part.nodes);
  sites.anchors = columns<Dim>(all.anchors, part.anchors);
  sites.points = columns<Dim>(all.points, part.points);
  for (int a : part.anchors) {
    const int node = all.anchor_node[a];
    sites.anchor_node.push_back(node < 0 ? -1 : local_node[node]);
    sites.anchor_zone.push_back(all.anchor_zone[a]);
    sites.wanted.push_back(all.wanted[a]);
  }
  for (int p : part.points) sites.point_anchor.push_back(local_anchor[all.point_anchor[p]]);
}

}  // namespace

template <int Dim>
std::vector<PartSites<Dim>> split_by_part(const Sites<Dim>& sites) {
  check_length(sites.node_part.size(), sites.node_count(), "nodes");
  check_length(sites.anchor_part.size(), sites.anchor_count(), "anchors");
  std::vector<PartSites<Dim>> parts(sites.part_blocks.size());
  std::vector<int> local_node(sites.node_part.size());
  std::vector<int> local_anchor(sites.anchor_part.size());
  for (int n = 0; n < sites.node_count(); ++n) {
    std::vector<int>& nodes = parts[sites.node_part[n]].nodes;
    local_node[n] = static_cast<int>(nodes.size());
    nodes.push_back(n);
  }
  for (int a = 0; a < sites.anchor_count(); ++a) {
    std::vector<int>& anchors = parts[sites.anchor_part[a]].anchors;
    local_anchor[a] = static_cast<int>(anchors.size());
    anchors.push_back(a);
  }
  for (int p = 0; p < sites.point_count(); ++p) {
    parts[sites.anchor_part[sites.point_anchor[p]]].points.push_back(p);
  }
  for (std::size_t p = 0; p < parts.size(); ++p) {
    fill_sites(sites, local_node, local_anchor, parts[p]);
    parts[p].sites.block = sites.part_blocks[p];
  }
  return parts;
}

template <int Dim>
Stencils join_stencils(const std::vector<PartSites<Dim>>& parts,
                       const std::vector<Stencils>& stencils) {
  const auto rows =
      origins(parts, [](const auto& part) -> const std::vector<int>& { return part.anchors; });
  Stencils all;
  all.offsets.reserve(rows.size() + 1);
  std::vector<int> ids;
  for (const auto& [part, row] : rows) {
    ids.clear();
    for (int node : stencils[part][row]) ids.push_back(parts[part].nodes[node]);
    all.push_back(ids);
  }
  return all;
}

template <int Dim>
Weights join_weights(const std::vector<PartSites<Dim>>& parts,
                     const std::vector<Weights>& weights) {
  const auto rows =
      origins(parts, [](const auto& part) -> const std::vector<int>& { return part.points; });
  Weights all;
  all.per_entry = weights.front().per_entry;
  all.offsets.reserve(rows.size() + 1);
  for (const auto& [part, row] : rows) {
    const Weights& of_part = weights[part];
    for (int node : of_part.nodes(row)) all.columns.push_back(parts[part].nodes[node]);
    const Eigen::Map<const Eigen::MatrixXd> values = of_part.row(row);
    all.values.insert(all.values.end(), values.data(), values.data() + values.size());
    all.offsets.push_back(static_cast<std::int64_t>(all.columns.size()));
  }
  return all;
}

#define STRONGPOINT_INSTANTIATE(Dim) /* the same three for every dimension */ \
  template std::vector<PartSites<Dim>> split_by_part(const Sites<Dim>&);      \
  template Stencils join_stencils(const std::vector<PartSites<Dim>>&,         \
                                  const std::vector<Stencils>&);              \
  template Weights join_weights(const std::vector<PartSites<Dim>>&, const std::vector<Weights>&);
STRONGPOINT_INSTANTIATE(1)
STRONGPOINT_INSTANTIATE(2)
STRONGPOINT_INSTANTIATE(3)
#undef STRONGPOINT_INSTANTIATE

}  // namespace strongpoint
