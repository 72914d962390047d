#include "methods/core/moving_batch.hpp"

#include <algorithm>

namespace strongpoint {
namespace {

/// Beyond it a fit is made by QR, which loses the root of it only: twelve digits are left.
constexpr double condition_limit = 1e4;

void grow_to(LaneArray& numbers, std::size_t size) {
  if (numbers.size() < size) numbers.resize(size);
}

}  // namespace

template <int Dim>
const double* MovingBatch<Dim>::weigh(const MovingParts<Dim>& parts, const StencilTable& table) {
  if (parts.weight == nullptr) return nullptr;
  const std::size_t lanes = lanes_of(simd_path());
  const std::size_t count = lanes * table.size;
  grow_to(z_, count * Dim);
  grow_to(rho_, count);
  grow_to(squared_, count);
  grow_to(radius_, lanes);
  unsigned faulty = 0;
  gather_stencils({table, Dim, z_.data(), rho_.data(), radius_.data(), &faulty});
  for (std::size_t i = 0; i < count; ++i) rho_[i] = std::max(rho_[i], parts.least_distance);
  parts.weight->squared({rho_.data(), count}, {squared_.data(), count});
  return squared_.data();
}

template <int Dim>
void MovingBatch<Dim>::fill(const MovingParts<Dim>& parts, const StencilBatch<Dim>& batch,
                            Weights& weights, std::span<LocalOutcome> outcomes) {
  numbers_.prepare(parts.monomials, parts.known);
  asked_.clear();
  for (const MultiIndex<Dim>& alpha : batch.derivatives) {
    asked_.push_back(parts.known.index(alpha));
  }
  const std::size_t terms = parts.monomials.size();
  const auto is_served = [&](int anchor) { return batch.stencils[anchor].size() >= terms; };
  const auto fit = [&](const StencilTable& table) {
    grow_to(scratch_, moving_scratch(Dim, table.size, terms, parts.known.size(), asked_.size(),
                                     lanes_of(simd_path())));
    unsigned done = 0;
    fit_moving({table,
                Dim,
                parts.profile,
                batch.sites.spacing.data(),
                weigh(parts, table),
                parts.uses_volumes ? batch.sites.volumes.data() : nullptr,
                numbers_.list(),
                condition_limit,
                numbers_.derivatives(),
                parts.products.data(),
                parts.product_offsets.data(),
                asked_.data(),
                static_cast<int>(asked_.size()),
                {batch.sites.points.data(), batch.points.offsets.data(), batch.points.nodes.data(),
                 weights.offsets.data(), weights.values.data()},
                scratch_.data(),
                &done});
    return done;
  };
  groups_.each(batch, is_served, fit, outcomes);
}

template class MovingBatch<1>;
template class MovingBatch<2>;
template class MovingBatch<3>;

}  // namespace strongpoint
