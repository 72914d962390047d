#pragma once

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "methods/core/error.hpp"
#include "methods/core/neighbours.hpp"
#include "methods/core/registry.hpp"
#include "methods/core/spacing.hpp"
#include "problems/core/layout.hpp"
#include "problems/core/voronoi.hpp"

namespace strongpoint {

/// Sites, stencils and a method on a cloud of the unit cube, for contract tests.
template <int Dim>
struct TestScene {
  PointCloud<Dim> cloud;
  Sites<Dim> sites;
  std::unique_ptr<Method<Dim>> method;
  Stencils stencils;
};

/// Nodes a side that hold even the largest stencil of an order well.
template <int Dim>
int test_level(int order) {
  if (Dim == 1) return 2 * order + 9;
  return Dim == 2 ? order + 8 : order + 4;
}

/// The scene of a method with its default stencil; every `stride`-th anchor is wanted. Boundary
/// nodes belong to the boundary zone.
template <int Dim>
TestScene<Dim> make_scene(const std::string& method, const std::string& cloud, int level,
                          int stride) {
  TestScene<Dim> scene;
  const UnitCube<Dim> domain;
  scene.cloud = make_cloud<Dim>(domain, cloud, LayoutRequest{level, 1});
  scene.method = make_method<Dim>(method).made;
  scene.sites = sites_at_nodes<Dim>(scene.cloud.nodes);
  scene.sites.block = scene.cloud.block;
  scene.sites.sees = [](const Point<Dim>&, const Point<Dim>&) { return true; };  // it is convex
  const auto search = make_search<Dim>("auto", scene.sites.nodes);
  if (scene.method->needs().volumes) {
    scene.sites.volumes = voronoi_volumes<Dim>(scene.cloud, domain, *search);
  }
  if (scene.method->needs().spacing) {
    scene.sites.spacing = local_spacing<Dim>(scene.sites.anchors, scene.sites.nodes, *search);
  }
  for (int a = 0; a < scene.sites.anchor_count(); ++a) {
    scene.sites.wanted[a] = a % stride == 0 ? 1 : 0;
    if (scene.cloud.is_boundary(a)) scene.sites.anchor_zone[a] = Zone::boundary;
  }
  if (scene.method->default_stencil() == every_node) return scene;
  const auto rule = make_rule<Dim>(scene.method->default_stencil()).made;
  scene.stencils = select_stencils<Dim>(*rule, scene.sites, *scene.method, *search);
  return scene;
}

/// Weights at points that belong to one anchor.
template <int Dim>
Weights weights_at(const TestScene<Dim>& scene, int anchor, const Points<Dim>& points,
                   const Derivatives<Dim>& derivatives) {
  Sites<Dim> sites = scene.sites;
  sites.points = points;
  sites.point_anchor.assign(points.cols(), anchor);
  Stencils only;
  for (int a = 0; a < sites.anchor_count(); ++a) {
    only.push_back(a == anchor ? scene.stencils[a] : std::span<const int>{});
  }
  return scene.method->weights(sites, only, derivatives);
}

/// True when a spec's values are within what the method offers and it exists in the dimension.
template <int Dim>
bool is_offered(const std::string& spec) {
  try {
    return make_method<Dim>(spec).made->unsupported({}).empty();
  } catch (const UsageError&) {
    return false;
  }
}

/// Every registered method that exists in the dimension by its default spec, then at the other
/// orders or degrees it offers up to `most`, then GFDM with every registered weight function.
template <int Dim = 2>
std::vector<std::string> method_specs(int most) {
  std::vector<std::string> specs;
  const auto add = [&](const std::string& spec) {
    if (is_offered<Dim>(spec)) specs.push_back(spec);
  };
  for (const MethodEntry& entry : methods()) {
    add(entry.info.name);
    for (const OptionDoc& option : entry.info.options) {
      if (option.key != "order" && option.key != "degree") continue;
      for (int p = 1; p <= most; ++p) {
        add(entry.info.name + "[" + option.key + "=" + std::to_string(p) + "]");
      }
    }
  }
  for (const WeightEntry& entry : weight_functions()) {
    add("gfdm[weight=" + entry.info.name + "]");
  }
  return specs;
}

/// All derivatives that a method supports, up to the order of the polynomials it reproduces and at
/// least the second, the value included.
template <int Dim>
Derivatives<Dim> supported_derivatives(const Method<Dim>& method) {
  Derivatives<Dim> result;
  for (const MultiIndex<Dim>& alpha :
       Derivatives<Dim>::between_orders(0, std::max(2, method.promises().reproduces))) {
    if (method.unsupported({alpha}).empty()) result.merge({alpha});
  }
  return result;
}

/// x^alpha.
template <int Dim>
double monomial(const Point<Dim>& x, const MultiIndex<Dim>& alpha) {
  double result = 1;
  for (int c = 0; c < Dim; ++c) {
    for (int k = 0; k < alpha[c]; ++k) result *= x[c];
  }
  return result;
}

}  // namespace strongpoint
