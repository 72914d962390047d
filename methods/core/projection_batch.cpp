#include "methods/core/projection_batch.hpp"

#include "methods/core/simd/projection_kernel.hpp"

namespace strongpoint {
namespace {

/// Beyond it a system is solved with exchanges: half the digits that a step of refinement makes
/// full are left.
constexpr double condition_limit = 1e6;

}  // namespace

template <int Dim>
void ProjectionBatch<Dim>::fill(const ProjectionParts<Dim>& parts, const StencilBatch<Dim>& batch,
                                Weights& weights, std::span<LocalOutcome> outcomes) {
  numbers_.prepare(parts.terms, batch.derivatives);
  const int terms = parts.terms.size();
  const auto is_served = [&](int anchor) {
    const std::span<const int> nodes = batch.stencils[anchor];
    if (static_cast<int>(nodes.size()) < parts.needed_nodes) return false;
    // The centre comes first, unless another node lies there too.
    return !parts.needs_centre || nodes[0] == batch.sites.anchor_node[anchor];
  };
  const auto project = [&](const StencilTable& table) {
    const std::size_t needed =
        projection_scratch(Dim, table.size, terms, batch.derivatives.size(), lanes_of(simd_path()));
    if (scratch_.size() < needed) scratch_.resize(needed);
    unsigned done = 0;
    project_taylor({table,
                    Dim,
                    parts.profile,
                    batch.sites.spacing.data(),
                    batch.sites.volumes.data(),
                    numbers_.list(),
                    parts.block_end.data(),
                    parts.is_nodal.data(),
                    condition_limit,
                    numbers_.derivatives(),
                    {batch.sites.points.data(), batch.points.offsets.data(),
                     batch.points.nodes.data(), weights.offsets.data(), weights.values.data()},
                    scratch_.data(),
                    &done});
    return done;
  };
  groups_.each(batch, is_served, project, outcomes);
}

template class ProjectionBatch<1>;
template class ProjectionBatch<2>;
template class ProjectionBatch<3>;

}  // namespace strongpoint
