// What methods refuse, and that they say why: missing needs, derivatives, degenerate stencils.
#include <algorithm>
#include <memory>
#include <numeric>
#include <stdexcept>

#include <gtest/gtest.h>
#include <omp.h>

#include "methods/core/error.hpp"
#include "methods/core/taylor_fit.hpp"
#include "tests/contract_support.hpp"

namespace strongpoint {
namespace {

TEST(ContractRefusals, ComeWhenADeclaredNeedIsDropped) {
  int with_needs = 0;
  for (const std::string& spec : method_specs(2)) {
    const TestScene<2> scene = make_scene<2>(spec, "perturbed", 10, 3);
    const Needs needs = scene.method->needs();
    EXPECT_EQ(scene.sites.volumes.size() > 0, needs.volumes)
        << spec << " is served with what it declares only";
    EXPECT_EQ(scene.sites.spacing.size() > 0, needs.spacing) << spec;
    const auto expect_refusal = [&](const Sites<2>& sites) {
      EXPECT_THROW(scene.method->weights(sites, scene.stencils, {{1, 0}}), CaseError) << spec;
      ++with_needs;
    };
    Sites<2> sites = scene.sites;
    sites.volumes.resize(0);
    if (needs.volumes) expect_refusal(sites);
    sites = scene.sites;
    sites.spacing.resize(0);
    if (needs.spacing) expect_refusal(sites);
    sites = scene.sites;
    sites.block.reset();
    if (needs.block) expect_refusal(sites);
    sites = scene.sites;
    std::fill(sites.anchor_node.begin(), sites.anchor_node.end(), -1);
    if (needs.centre) expect_refusal(sites);
  }
  EXPECT_GE(with_needs, 2);  // mfpm_original and gfdm[weight=volume] at least
}

TEST(ContractRefusals, CoverDerivativesThatCannotBeGiven) {
  for (const std::string& spec : method_specs(3)) {
    const auto method = make_method<2>(spec).made;
    EXPECT_EQ(method->unsupported({{1, 0}}), "") << spec;
    EXPECT_NE(method->unsupported({{15, 15}}), "") << spec;
  }
}

/// Weights at node 0 of hand-made nodes with the whole cloud as stencil, or the error's message.
template <int Dim>
std::string error_of(const std::string& spec, const Points<Dim>& nodes, int size) {
  Sites<Dim> sites = sites_at_nodes<Dim>(nodes);
  std::fill(sites.wanted.begin() + 1, sites.wanted.end(), 0);
  sites.volumes = Eigen::VectorXd::Ones(nodes.cols());
  sites.spacing = Eigen::VectorXd::Constant(nodes.cols(), 0.125);
  std::vector<int> stencil(size);
  std::iota(stencil.begin(), stencil.end(), 0);
  sort_stencil<Dim>(sites, 0, stencil);
  Stencils stencils;
  for (int a = 0; a < sites.anchor_count(); ++a) {
    stencils.push_back(a == 0 ? std::span<const int>(stencil) : std::span<const int>{});
  }
  try {
    make_method<Dim>(spec).made->weights(sites, stencils, {{1, 0}});
  } catch (const CaseError& error) {
    return error.what();
  }
  return "no error";
}

TEST(ContractRefusals, NameTheNodeAndTheRemedyOfDegenerateStencils) {
  const Points<2> scattered = make_cloud<2>(UnitCube<2>{}, "perturbed", LayoutRequest{9, 1}).nodes;
  Points<2> line = scattered;
  for (int i = 0; i < line.cols(); ++i) line.col(i) << 0.1 * i, 0.03 * i + 1;
  Points<2> twice = scattered;
  twice.col(40) = twice.col(7);
  for (const std::string& spec : method_specs(4)) {
    const auto method = make_method<2>(spec).made;
    const bool chooses_itself = !method->promises().local || method->needs().block;
    if (chooses_itself) continue;
    const std::string coincident = error_of<2>(spec, twice, 60);
    EXPECT_NE(coincident.find("node 0"), std::string::npos) << spec << ": " << coincident;
    EXPECT_NE(coincident.find("same place"), std::string::npos) << spec << ": " << coincident;
    if (method->promises().reproduces < 0) continue;  // two nodes or a line may be enough
    for (const std::string& message :
         {error_of<2>(spec, scattered, 2), error_of<2>(spec, line, 60)}) {
      EXPECT_NE(message.find("node 0"), std::string::npos) << spec << ": " << message;
      EXPECT_NE(message.find("larger k"), std::string::npos) << spec << ": " << message;
    }
  }
}

/// Gives up on a stencil of some size, as a user's weight might.
class ThrowingWeight final : public WeightFunction {
 public:
  void squared(std::span<const double>, std::span<double>) const override {
    throw std::runtime_error("this weight gives up");
  }
};

TEST(ContractRefusals, WhatAKernelThrowsLeavesTheParallelLoopAsAnError) {
  const auto method = make_taylor_method<2>("thrower", 2, std::make_shared<ThrowingWeight>(),
                                            StencilSurplus{2, 2, 2}, "nearest");
  const TestScene<2> scene = make_scene<2>("lsfdm", "grid", 15, 1);
  omp_set_num_threads(4);
  EXPECT_THROW(method->weights(scene.sites, scene.stencils, {{1, 0}}), std::runtime_error);
  const std::vector<int> anchors = scene.sites.wanted_anchors();
  EXPECT_THROW(
      method->condition(scene.sites, anchors, scene.stencils, Scaling::both, ConditionNorm::two),
      std::runtime_error);
  omp_set_num_threads(1);
}

}  // namespace
}  // namespace strongpoint
