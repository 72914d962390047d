#include "methods/core/taylor_batch.hpp"

#include <algorithm>
#include <cmath>

namespace strongpoint {
namespace {

/// Numbers of gathered stencils that are treated at a time: they stay in the first-level cache.
constexpr std::size_t gathered_at_a_time = 3072;

}  // namespace

template <int Dim>
void TaylorBatch<Dim>::sort_by_size(const StencilBatch<Dim>& batch, int needed) {
  by_size_.clear();
  bool sorted = true;
  for (std::size_t i = 0; i < batch.anchors.size(); ++i) {
    const int anchor = batch.anchors[i];
    const std::span<const int> nodes = batch.stencils[anchor];
    const int size = static_cast<int>(nodes.size());
    // The centre comes first, unless another node lies there too.
    if (size < needed || nodes[0] != batch.sites.anchor_node[anchor]) continue;
    sorted = sorted && (by_size_.empty() || by_size_.back().first <= size);
    by_size_.emplace_back(size, static_cast<int>(i));
  }
  if (!sorted) std::sort(by_size_.begin(), by_size_.end());
}

template <int Dim>
void TaylorBatch<Dim>::tabulate(const MonomialBasis<Dim>& basis,
                                const Derivatives<Dim>& derivatives) {
  const int terms = basis.terms();
  const auto entries = static_cast<std::size_t>(terms) * derivatives.size();
  if (derivatives == derivatives_ && factors_.size() == entries) return;
  derivatives_ = derivatives;
  orders_.clear();
  factors_.clear();
  powers_.clear();
  for (const MultiIndex<Dim>& alpha : derivatives) {
    orders_.push_back(order_of<Dim>(alpha));
    for (const MultiIndex<Dim>& monomial : basis.monomials()) {
      MultiIndex<Dim> left{};
      bool vanishes = false;
      for (int c = 0; c < Dim; ++c) {
        left[c] = monomial[c] - alpha[c];
        vanishes = vanishes || left[c] < 0;
      }
      const bool is_constant = left == MultiIndex<Dim>{};
      factors_.push_back(vanishes ? 0 : factorial<Dim>(monomial) / factorial<Dim>(left));
      powers_.push_back(vanishes || is_constant ? -1 : basis.monomials().index(left));
    }
  }
}

template <int Dim>
GatherTask TaylorBatch<Dim>::gather(const StencilBatch<Dim>& batch, const WeightFunction& weight,
                                    std::span<const std::pair<int, int>> part) {
  const std::size_t lanes = lanes_of(simd_path());
  const std::size_t groups = (part.size() + lanes - 1) / lanes;
  const std::size_t size = part.back().first;
  chosen_.clear();
  for (const auto& [ignored, place] : part) chosen_.push_back(batch.anchors[place]);
  z_.resize(std::max(z_.size(), groups * lanes * size * Dim));
  rho_.resize(std::max(rho_.size(), groups * lanes * size));
  squared_.resize(rho_.size());
  radius_.resize(std::max(radius_.size(), groups * lanes));
  faulty_.resize(std::max(faulty_.size(), groups));
  done_.resize(faulty_.size());
  const GatherTask task{{batch.sites.nodes.data(), batch.sites.anchors.data(),
                         batch.stencils.offsets.data(), batch.stencils.nodes.data(), chosen_.data(),
                         static_cast<int>(chosen_.size()), static_cast<int>(size)},
                        Dim,
                        weight.uses_volumes() ? Distances::squares : Distances::roots,
                        z_.data(),
                        rho_.data(),
                        radius_.data(),
                        faulty_.data()};
  gather_stencils(task);
  for (std::size_t group = 0; group < groups; ++group) {  // the centre's distance does not count
    double* const centre = rho_.data() + group * lanes * size;
    std::fill(centre, centre + lanes, 1.0);
  }
  weigh(batch, weight, task);
  return task;
}

template <int Dim>
void TaylorBatch<Dim>::weigh(const StencilBatch<Dim>& batch, const WeightFunction& weight,
                             const GatherTask& task) {
  const std::size_t lanes = lanes_of(simd_path());
  const std::size_t size = task.table.size;
  const std::size_t count = (chosen_.size() + lanes - 1) / lanes * lanes * size;
  if (!weight.uses_volumes()) {
    weight.squared({rho_.data(), count}, {squared_.data(), count});
    return;
  }
  for (std::size_t i = 0; i < chosen_.size(); ++i) {
    const double unit = std::pow(radius_[i], -Dim);
    double* next = squared_.data() + i / lanes * lanes * size + i % lanes;
    for (int node : batch.stencils[chosen_[i]]) {
      *next = batch.sites.volumes[node] * unit;
      next += lanes;
    }
  }
}

template <int Dim>
void TaylorBatch<Dim>::fill(const MonomialBasis<Dim>& basis, const WeightFunction& weight,
                            const TaylorLimits& limits, const StencilBatch<Dim>& batch,
                            Weights& weights, std::span<LocalOutcome> outcomes) {
  const std::size_t lanes = lanes_of(simd_path());
  sort_by_size(batch, basis.terms() + 1);
  tabulate(basis, batch.derivatives);
  const std::size_t count = by_size_.size();
  for (std::size_t begin = 0, end = 0; begin < count; begin = end) {
    const int size = by_size_[std::min(begin + lanes, count) - 1].first;
    const std::size_t most =
        std::max<std::size_t>(1, gathered_at_a_time / (lanes * size * (Dim + 2)));
    end = begin;
    for (std::size_t group = 0; group < most && end < count; ++group) {
      const std::size_t next = std::min(end + lanes, count);
      if (by_size_[next - 1].first != size) break;
      end = next;
    }
    const std::span<const std::pair<int, int>> part(by_size_.data() + begin, end - begin);
    scratch_.resize(std::max(scratch_.size(),
                             taylor_scratch(size, basis.terms(), batch.derivatives.size(), lanes)));
    fit_taylor({gather(batch, weight, part),
                basis.degree(),
                limits.least_pivot,
                limits.condition,
                squared_.data(),
                {batch.derivatives.size(), orders_.data(), factors_.data(), powers_.data()},
                {batch.sites.points.data(), batch.points.offsets.data(), batch.points.nodes.data(),
                 weights.offsets.data(), weights.values.data()},
                scratch_.data(),
                done_.data()});
    for (std::size_t i = 0; i < part.size(); ++i) {
      if ((done_[i / lanes] >> (i % lanes) & 1U) != 0) outcomes[part[i].second] = LocalOutcome::ok;
    }
  }
}

template class TaylorBatch<1>;
template class TaylorBatch<2>;
template class TaylorBatch<3>;

}  // namespace strongpoint
