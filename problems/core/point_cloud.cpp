#include "problems/core/point_cloud.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "methods/core/error.hpp"
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

template <int Dim>
void check_distinct(const Points<Dim>& nodes) {
  const Point<Dim> low = nodes.rowwise().minCoeff();
  const Point<Dim> high = nodes.rowwise().maxCoeff();
  const double tolerance = coincidence_tolerance * (high - low).norm();
  const std::vector<double> radii(static_cast<std::size_t>(nodes.cols()), tolerance);
  const Stencils near = make_search<Dim>("nanoflann", nodes)->within(nodes, radii);
  for (int i = 0; i < near.size(); ++i) {
    for (int other : near[i]) {
      if (other == i) continue;
      throw CaseError(fmt::format(
          "nodes {} and {} coincide: {} and {} are {:.3g} apart; remove one of them",
          std::min(i, other), std::max(i, other), format_point(nodes.col(std::min(i, other))),
          format_point(nodes.col(std::max(i, other))), (nodes.col(i) - nodes.col(other)).norm()));
    }
  }
}

}  // namespace

template <int Dim>
double PointCloud<Dim>::spacing() const {
  return std::pow(measure / size(), 1.0 / Dim);
}

template <int Dim>
Sites<Dim> sites_of_cloud(const PointCloud<Dim>& cloud) {
  Sites<Dim> sites = sites_at_nodes<Dim>(cloud.nodes);
  sites.block = cloud.block;
  for (int i = 0; i < cloud.size(); ++i) {
    if (cloud.is_boundary(i)) sites.anchor_zone[i] = Zone::boundary;
  }
  return sites;
}

template <int Dim>
void CloudBuilder<Dim>::add(const Point<Dim>& x, std::vector<BoundaryMark<Dim>> marks) {
  const auto by_side = [](const auto& a, const auto& b) { return a.side < b.side; };
  const auto same_side = [](const auto& a, const auto& b) { return a.side == b.side; };
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
  nodes_.clear();
  marks_.clear();
  check_finite<Dim>(cloud.nodes);
  check_distinct<Dim>(cloud.nodes);
  return cloud;
}

template struct PointCloud<1>;
template struct PointCloud<2>;
template struct PointCloud<3>;
template Sites<1> sites_of_cloud(const PointCloud<1>&);
template Sites<2> sites_of_cloud(const PointCloud<2>&);
template Sites<3> sites_of_cloud(const PointCloud<3>&);
template class CloudBuilder<1>;
template class CloudBuilder<2>;
template class CloudBuilder<3>;

}  // namespace strongpoint
