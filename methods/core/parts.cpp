#include "methods/core/parts.hpp"

#include <algorithm>
#include <numeric>

#include <fmt/format.h>

#include "methods/core/error.hpp"
#include "methods/core/spans.hpp"

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
  if (all.spans.cols() > 0) sites.spans = columns<Dim>(all.spans, part.points);
  for (int a : part.anchors) {
    const int node = all.anchor_node[a];
    sites.anchor_node.push_back(node < 0 ? -1 : local_node[node]);
    sites.anchor_zone.push_back(all.anchor_zone[a]);
    sites.wanted.push_back(all.wanted[a]);
  }
  for (int p : part.points) sites.point_anchor.push_back(local_anchor[all.point_anchor[p]]);
  if (all.volumes.size() > 0) sites.volumes = all.volumes(part.nodes);
  if (all.spacing.size() > 0) sites.spacing = all.spacing(part.anchors);
}

/// The stencils of the anchors of one part among those listed, with the part's ids.
template <int Dim>
struct PartStencils {
  std::vector<int> anchors;
  Stencils stencils;
  std::vector<int> places;  ///< of each in the list

  PartStencils(const PartSites<Dim>& part, std::span<const int> listed, const Stencils& all) {
    std::vector<int> ids;
    for (std::size_t i = 0; i < listed.size(); ++i) {
      const auto found = std::lower_bound(part.anchors.begin(), part.anchors.end(), listed[i]);
      if (found == part.anchors.end() || *found != listed[i]) continue;
      anchors.push_back(static_cast<int>(found - part.anchors.begin()));
      places.push_back(static_cast<int>(i));
      ids.clear();
      for (int node : all[static_cast<int>(i)]) {
        const auto own = std::lower_bound(part.nodes.begin(), part.nodes.end(), node);
        ids.push_back(static_cast<int>(own - part.nodes.begin()));
      }
      stencils.push_back(ids);
    }
  }
};

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

template <int Dim>
Weights weights_by_part(const Method<Dim>& method, const Sites<Dim>& sites,
                        const Stencils& stencils, const Derivatives<Dim>& derivatives) {
  if (sites.part_blocks.empty()) return weights_on(method, sites, stencils, derivatives);
  std::vector<int> anchors(static_cast<std::size_t>(stencils.size()));
  std::iota(anchors.begin(), anchors.end(), 0);
  const std::vector<PartSites<Dim>> parts = split_by_part(sites);
  std::vector<Weights> weights;
  weights.reserve(parts.size());
  for (const PartSites<Dim>& part : parts) {
    const PartStencils<Dim> own(part, anchors, stencils);
    weights.push_back(weights_on(method, part.sites, own.stencils, derivatives));
  }
  return join_weights(parts, weights);
}

template <int Dim>
std::vector<double> condition_by_part(const Method<Dim>& method, const Sites<Dim>& sites,
                                      std::span<const int> anchors, const Stencils& stencils,
                                      Scaling scaling, ConditionNorm norm) {
  if (sites.part_blocks.empty()) return method.condition(sites, anchors, stencils, scaling, norm);
  std::vector<double> all(anchors.size());
  for (const PartSites<Dim>& part : split_by_part(sites)) {
    const PartStencils<Dim> own(part, anchors, stencils);
    const std::vector<double> conditions =
        method.condition(part.sites, own.anchors, own.stencils, scaling, norm);
    for (std::size_t i = 0; i < own.places.size(); ++i) all[own.places[i]] = conditions[i];
  }
  return all;
}

template std::vector<PartSites<1>> split_by_part(const Sites<1>&);
template Stencils join_stencils(const std::vector<PartSites<1>>&, const std::vector<Stencils>&);
template Weights join_weights(const std::vector<PartSites<1>>&, const std::vector<Weights>&);
template Weights weights_by_part(const Method<1>&, const Sites<1>&, const Stencils&,
                                 const Derivatives<1>&);
template std::vector<double> condition_by_part(const Method<1>&, const Sites<1>&,
                                               std::span<const int>, const Stencils&, Scaling,
                                               ConditionNorm);
template std::vector<PartSites<2>> split_by_part(const Sites<2>&);
template Stencils join_stencils(const std::vector<PartSites<2>>&, const std::vector<Stencils>&);
template Weights join_weights(const std::vector<PartSites<2>>&, const std::vector<Weights>&);
template Weights weights_by_part(const Method<2>&, const Sites<2>&, const Stencils&,
                                 const Derivatives<2>&);
template std::vector<double> condition_by_part(const Method<2>&, const Sites<2>&,
                                               std::span<const int>, const Stencils&, Scaling,
                                               ConditionNorm);
template std::vector<PartSites<3>> split_by_part(const Sites<3>&);
template Stencils join_stencils(const std::vector<PartSites<3>>&, const std::vector<Stencils>&);
template Weights join_weights(const std::vector<PartSites<3>>&, const std::vector<Weights>&);
template Weights weights_by_part(const Method<3>&, const Sites<3>&, const Stencils&,
                                 const Derivatives<3>&);
template std::vector<double> condition_by_part(const Method<3>&, const Sites<3>&,
                                               std::span<const int>, const Stencils&, Scaling,
                                               ConditionNorm);

}  // namespace strongpoint
