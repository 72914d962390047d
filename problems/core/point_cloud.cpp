#include "problems/core/point_cloud.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "methods/core/error.hpp"
#include "methods/core/hilbert.hpp"
#include "methods/core/neighbours.hpp"

namespace strongpoint {
namespace {

/// Nodes closer than this fraction of the cloud's extent cannot be told apart by any method.
constexpr double coincidence_tolerance = 1e-10;

template <int Dim>
void check_finite(const Points<Dim>& nodes) {
  for (Eigen::Index i = 0; i < nodes.cols(); ++i) {
    if (nodes.col(i).allFinite()) continue;
    throw CaseError(
        fmt::format("node {} has a coordinate that is not finite: {}; give finite numbers", i,
                    format_point(nodes.col(i))));
  }
}

/// The nodes at the place of each node, itself among them.
template <int Dim>
Stencils coincident_nodes(const Points<Dim>& nodes) {
  const Point<Dim> low = nodes.rowwise().minCoeff();
  const Point<Dim> high = nodes.rowwise().maxCoeff();
  const double tolerance = coincidence_tolerance * (high - low).norm();
  const std::vector<double> radii(static_cast<std::size_t>(nodes.cols()), tolerance);
  return make_search<Dim>("nanoflann", nodes)->within(nodes, radii);
}

template <int Dim>
void check_distinct(const PointCloud<Dim>& cloud, const Stencils& near) {
  const Points<Dim>& nodes = cloud.nodes;
  for (int i = 0; i < near.size(); ++i) {
    for (int other : near[i]) {
      if (other == i || cloud.part_of(i) != cloud.part_of(other)) continue;
      throw CaseError(fmt::format(
          "nodes {} and {} coincide: {} and {} are {:.3g} apart; remove one of them",
          std::min(i, other), std::max(i, other), format_point(nodes.col(std::min(i, other))),
          format_point(nodes.col(std::max(i, other))), (nodes.col(i) - nodes.col(other)).norm()));
    }
  }
}

/// The other nodes at the place of each node on an interface.
template <int Dim>
Stencils find_twins(const PointCloud<Dim>& cloud, const Stencils& near) {
  Stencils twins;
  std::vector<int> others;
  for (int i = 0; i < near.size(); ++i) {
    others.clear();
    const bool is_met = !cloud.interfaces_of(i).empty();
    for (int other : near[i]) {
      if (is_met && other != i && !cloud.interfaces_of(other).empty()) others.push_back(other);
    }
    std::sort(others.begin(), others.end());
    twins.push_back(others);
  }
  return twins;
}

}  // namespace

template <int Dim>
int PointCloud<Dim>::part_of(int node) const {
  if (parts.empty()) return 0;
  const auto after =
      std::upper_bound(parts.begin(), parts.end(), node,
                       [](int id, const Part<Dim>& part) { return id < part.first; });
  return static_cast<int>(after - parts.begin()) - 1;
}

template <int Dim>
double PointCloud<Dim>::spacing() const {
  return std::pow(measure / size(), 1.0 / Dim);
}

template <int Dim>
Sites<Dim> sites_of_cloud(const PointCloud<Dim>& cloud) {
  Sites<Dim> sites = sites_at_nodes<Dim>(cloud.nodes);
  sites.block = cloud.block;
  sites.node_numbers = cloud.numbers;
  for (int i = 0; i < cloud.size(); ++i) {
    if (cloud.is_boundary(i)) sites.anchor_zone[i] = Zone::boundary;
  }
  for (const Part<Dim>& part : cloud.parts) {
    sites.node_part.insert(sites.node_part.end(), part.count,
                           static_cast<int>(sites.part_blocks.size()));
    sites.part_blocks.push_back(part.block);
  }
  sites.anchor_part = sites.node_part;
  return sites;
}

template <int Dim>
PointCloud<Dim> cloud_of_part(const PointCloud<Dim>& cloud, int part) {
  const Part<Dim> whole{0, cloud.size(), 0, cloud.block};
  const Part<Dim>& from = cloud.parts.empty() ? whole : cloud.parts[part];
  PointCloud<Dim> result;
  result.nodes = cloud.nodes.middleCols(from.first, from.count);
  for (int i = from.first; i < from.first + from.count; ++i) {
    const auto marks = cloud.marks_of(i);
    result.marks.insert(result.marks.end(), marks.begin(), marks.end());
    result.mark_offsets.push_back(static_cast<int>(result.marks.size()));
  }
  result.block = from.block;
  result.measure = cloud.measure;
  return result;
}

template <int Dim>
PointCloud<Dim> reordered(const PointCloud<Dim>& cloud, const std::vector<int>& order) {
  PointCloud<Dim> result;
  result.measure = cloud.measure;
  result.nodes = columns_of<Dim>(cloud.nodes, order);
  for (int node : order) {
    const auto marks = cloud.all_marks_of(node);
    result.marks.insert(result.marks.end(), marks.begin(), marks.end());
    result.mark_offsets.push_back(static_cast<int>(result.marks.size()));
    result.numbers.push_back(cloud.number_of(node));
  }
  return result;
}

template <int Dim>
PointCloud<Dim> along_curve(const PointCloud<Dim>& cloud) {
  if (cloud.block || !cloud.parts.empty()) return cloud;
  return reordered(cloud, hilbert_order<Dim>(cloud.nodes));
}

template <int Dim>
Eigen::MatrixXd in_given_order(const PointCloud<Dim>& cloud, const Eigen::MatrixXd& values) {
  if (cloud.numbers.empty() || values.cols() != cloud.size()) return values;
  Eigen::MatrixXd result(values.rows(), values.cols());
  for (int node = 0; node < cloud.size(); ++node) {
    result.col(cloud.numbers[node]) = values.col(node);
  }
  return result;
}

template <int Dim>
void check_interfaces(const PointCloud<Dim>& cloud) {
  for (int i = 0; i < cloud.size(); ++i) {
    if (cloud.interfaces_of(i).empty() || !cloud.twins_of(i).empty()) continue;
    throw CaseError(
        fmt::format("node {} at {} lies on an interface but meets no node of another part; place "
                    "the same nodes on both sides, as grid and blocks do",
                    i, format_point(cloud.nodes.col(i))));
  }
}

template <int Dim>
void CloudBuilder<Dim>::begin_part(int patch, std::optional<IndexBlock<Dim>> block) {
  parts_.push_back({size(), 0, patch, std::move(block)});
}

template <int Dim>
void CloudBuilder<Dim>::add(const Point<Dim>& x, std::vector<BoundaryMark<Dim>> marks) {
  const auto by_side = [](const auto& a, const auto& b) { return a.side < b.side; };
  const auto same_side = [](const auto& a, const auto& b) {
    return a.side == b.side && (a.side != interface_side || a.normal == b.normal);
  };
  std::stable_sort(marks.begin(), marks.end(), by_side);
  marks.erase(std::unique(marks.begin(), marks.end(), same_side), marks.end());
  nodes_.push_back(x);
  marks_.push_back(std::move(marks));
}

template <int Dim>
PointCloud<Dim> CloudBuilder<Dim>::finish(double measure) {
  if (size() < 2) {
    throw CaseError(fmt::format("the cloud has {} node{}; at least 2 are needed", size(),
                                size() == 1 ? "" : "s"));
  }
  PointCloud<Dim> cloud;
  cloud.measure = measure;
  cloud.nodes.resize(Dim, size());
  for (int i = 0; i < size(); ++i) {
    cloud.nodes.col(i) = nodes_[i];
    cloud.marks.insert(cloud.marks.end(), marks_[i].begin(), marks_[i].end());
    cloud.mark_offsets.push_back(static_cast<int>(cloud.marks.size()));
  }
  for (Part<Dim>& part : parts_) {
    const bool is_last = &part == &parts_.back();
    part.count = (is_last ? size() : (&part + 1)->first) - part.first;
  }
  cloud.parts = std::move(parts_);
  nodes_.clear();
  marks_.clear();
  parts_.clear();
  check_finite<Dim>(cloud.nodes);
  const Stencils near = coincident_nodes<Dim>(cloud.nodes);
  check_distinct<Dim>(cloud, near);
  if (!cloud.parts.empty()) cloud.twins = find_twins<Dim>(cloud, near);
  return cloud;
}

template struct PointCloud<1>;
template struct PointCloud<2>;
template struct PointCloud<3>;
template Sites<1> sites_of_cloud(const PointCloud<1>&);
template Sites<2> sites_of_cloud(const PointCloud<2>&);
template Sites<3> sites_of_cloud(const PointCloud<3>&);
template void check_interfaces(const PointCloud<1>&);
template PointCloud<1> cloud_of_part(const PointCloud<1>&, int);
template PointCloud<1> reordered(const PointCloud<1>&, const std::vector<int>&);
template PointCloud<1> along_curve(const PointCloud<1>&);
template Eigen::MatrixXd in_given_order(const PointCloud<1>&, const Eigen::MatrixXd&);
template PointCloud<2> reordered(const PointCloud<2>&, const std::vector<int>&);
template PointCloud<2> along_curve(const PointCloud<2>&);
template Eigen::MatrixXd in_given_order(const PointCloud<2>&, const Eigen::MatrixXd&);
template PointCloud<3> reordered(const PointCloud<3>&, const std::vector<int>&);
template PointCloud<3> along_curve(const PointCloud<3>&);
template Eigen::MatrixXd in_given_order(const PointCloud<3>&, const Eigen::MatrixXd&);
template void check_interfaces(const PointCloud<2>&);
template PointCloud<2> cloud_of_part(const PointCloud<2>&, int);
template void check_interfaces(const PointCloud<3>&);
template PointCloud<3> cloud_of_part(const PointCloud<3>&, int);
template class CloudBuilder<1>;
template class CloudBuilder<2>;
template class CloudBuilder<3>;

}  // namespace strongpoint
