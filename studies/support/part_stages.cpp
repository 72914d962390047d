#include "studies/support/part_stages.hpp"

#include "methods/core/error.hpp"
#include "methods/core/parts.hpp"

namespace strongpoint {
namespace {

/// The domain whose boundary a part of the cloud has.
template <int Dim>
const Domain<Dim>& domain_of_part(const PointCloud<Dim>& cloud, int part, const Domain<Dim>& domain,
                                  const Method<Dim>& method) {
  const std::vector<const Domain<Dim>*> patches = domain.patches();
  if (patches.size() == cloud.parts.size()) return *patches[cloud.parts[part].patch];
  if (!method.needs().volumes) return domain;
  throw SkipCase("the method needs cell volumes, which are not made for a cloud of several blocks");
}

/// Copies what was prepared for a part, if anything, to its ids in the whole.
void keep(const Eigen::VectorXd& of_part, const std::vector<int>& ids, int count,
          Eigen::VectorXd& all) {
  if (of_part.size() == 0) return;
  all.conservativeResize(count);
  all(ids) = of_part;
}

}  // namespace

template <int Dim>
void walk_parts(Discretisation<Dim>& scene, const Domain<Dim>& domain, const Choices<Dim>& choices,
                const RunOptions& options, const StageClock& clock, StageTimes& times, Upto upto) {
  std::vector<PartSites<Dim>> parts =
      clock.time(times.prepare, [&] { return split_by_part<Dim>(scene.sites); });
  std::vector<Stencils> stencils;
  std::vector<Weights> weights;
  const auto& advance = upto == Upto::weights ? compute_weights<Dim> : choose_stencils<Dim>;
  for (int p = 0; p < static_cast<int>(parts.size()); ++p) {
    Discretisation<Dim> piece;
    piece.derivatives = scene.derivatives;
    clock.time(times.prepare, [&] {
      piece.cloud = cloud_of_part<Dim>(scene.cloud, p);
      piece.sites = std::move(parts[p].sites);
    });
    advance(piece, domain_of_part(scene.cloud, p, domain, *choices.method), choices, options, clock,
            times);
    keep(piece.sites.volumes, parts[p].nodes, scene.sites.node_count(), scene.sites.volumes);
    keep(piece.sites.spacing, parts[p].anchors, scene.sites.anchor_count(), scene.sites.spacing);
    stencils.push_back(std::move(piece.stencils));
    weights.push_back(std::move(piece.weights));
  }
  if (choices.rule) {
    scene.stencils = clock.time(times.stencils, [&] { return join_stencils(parts, stencils); });
  }
  if (upto == Upto::weights) {
    scene.weights = clock.time(times.weights, [&] { return join_weights(parts, weights); });
  }
}

template void walk_parts(Discretisation<1>&, const Domain<1>&, const Choices<1>&, const RunOptions&,
                         const StageClock&, StageTimes&, Upto);
template void walk_parts(Discretisation<2>&, const Domain<2>&, const Choices<2>&, const RunOptions&,
                         const StageClock&, StageTimes&, Upto);
template void walk_parts(Discretisation<3>&, const Domain<3>&, const Choices<3>&, const RunOptions&,
                         const StageClock&, StageTimes&, Upto);

}  // namespace strongpoint
