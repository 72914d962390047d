#pragma once

#include <algorithm>
#include <memory>
#include <string>

#include <fmt/format.h>

#include "methods/core/error.hpp"
#include "methods/core/registry.hpp"
#include "methods/core/spacing.hpp"
#include "problems/core/layout.hpp"
#include "problems/core/voronoi.hpp"

namespace strongpoint {

/// Nodes per side of the benchmarks' clouds: about ten thousand nodes in every dimension, more than
/// fit into a cache of the second level with their stencils.
template <int Dim>
inline constexpr int bench_level = Dim == 2 ? 101 : 22;

/// The cloud of the local benchmarks; its seed is part of the spec.
inline constexpr const char* bench_cloud = "perturbed[amount=0.2,seed=1]";

/// Everything that is ready before a method computes: sites and stencils on a perturbed grid.
template <int Dim>
struct LocalCase {
  std::unique_ptr<Method<Dim>> method;
  std::string stencil;  ///< canonical spec of the rule
  PointCloud<Dim> cloud;
  Sites<Dim> sites;
  Stencils stencils;

  /// Mean number of nodes in a stencil.
  double mean_k() const { return static_cast<double>(stencils.nodes.size()) / stencils.size(); }
  /// What a benchmark says of itself: stencil, k, dimension, number of nodes, cloud with its seed.
  std::string label() const {
    return fmt::format("{} k={:.1f} Dim={} N={} {}", stencil, mean_k(), Dim, cloud.size(),
                       bench_cloud);
  }
};

/// Prepares a method on a cloud, with a stencil rule or, when `stencil` is empty, its default one.
/// Throws as the parts do, with a sentence for combinations that cannot be served.
template <int Dim>
LocalCase<Dim> make_local_case(const std::string& method, const std::string& stencil) {
  LocalCase<Dim> made;
  made.method = make_method<Dim>(method).made;
  if (!made.method->promises().local) {
    throw SkipCase("the method uses every node of the cloud, for which these clouds are too large");
  }
  auto rule = make_rule<Dim>(stencil.empty() ? made.method->default_stencil() : stencil);
  made.stencil = rule.spec;
  const UnitCube<Dim> domain;
  made.cloud = make_cloud<Dim>(domain, bench_cloud, {.level = bench_level<Dim>});
  made.sites = sites_at_nodes<Dim>(made.cloud.nodes);
  made.sites.block = made.cloud.block;
  for (int i = 0; i < made.cloud.size(); ++i) {
    if (made.cloud.is_boundary(i)) made.sites.anchor_zone[i] = Zone::boundary;
  }
  const auto search = make_search<Dim>("auto", made.sites.nodes);
  if (made.method->needs().volumes) {
    made.sites.volumes = voronoi_volumes<Dim>(made.cloud, domain, *search);
  }
  if (made.method->needs().spacing) {
    made.sites.spacing = local_spacing<Dim>(made.sites.anchors, made.sites.nodes, *search);
  }
  made.stencils = select_stencils<Dim>(*rule.made, made.sites, *made.method, *search);
  return made;
}

}  // namespace strongpoint
