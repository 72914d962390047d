#pragma once

#include "studies/support/run_case.hpp"

namespace strongpoint {

/// True when stencils have to keep within parts of the cloud.
template <int Dim>
bool has_parts(const Discretisation<Dim>& scene) {
  return !scene.sites.part_blocks.empty();
}

/// Walks the stages up to stencils or weights part by part, and joins what they give: rules and
/// methods see one part at a time. Throws SkipCase when the method needs cell volumes and the parts
/// are blocks of a domain.
template <int Dim>
void walk_parts(Discretisation<Dim>& scene, const Domain<Dim>& domain, const Choices<Dim>& choices,
                const RunOptions& options, const StageClock& clock, StageTimes& times, Upto upto);

}  // namespace strongpoint
