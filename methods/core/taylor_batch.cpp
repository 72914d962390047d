#include "methods/core/taylor_batch.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "methods/core/simd/taylor_condition.hpp"

namespace strongpoint {
namespace {

/// Asks for the ids of stencils that come soon, past the end of which nothing happens.
inline void fetch_ahead(const int* ids) {
  constexpr std::ptrdiff_t ahead = 1024;
  __builtin_prefetch(ids + ahead);
}

template <class Number>
void grow_to(std::vector<Number>& numbers, std::size_t size) {
  if (numbers.size() < size) numbers.resize(size);
}
void grow_to(LaneArray& numbers, std::size_t size) {
  if (numbers.size() < size) numbers.resize(size);
}

/// A weight function as kernels take it.
NodeWeights weights_of(const WeightFunction& weight, const double* volumes) {
  if (weight.is_one()) return {};
  if (weight.uses_volumes()) return {.volumes = volumes};
  if (weight.formula() != nullptr) return {.formula = weight.formula()};
  const auto squared = [](const void* function, const double* rho, double* result, long count) {
    const auto size = static_cast<std::size_t>(count);
    static_cast<const WeightFunction*>(function)->squared({rho, size}, {result, size});
  };
  return {.squared = squared, .function = &weight};
}

}  // namespace

template <int Dim>
std::span<const SizeOrder::Entry> TaylorBatch<Dim>::ordered(const Sites<Dim>& sites,
                                                            std::span<const int> anchors,
                                                            const Stencils& stencils, int needed) {
  order_.begin(anchors.size());
  for (std::size_t i = 0; i < anchors.size(); ++i) {
    const std::span<const int> nodes = stencils[stencil_of_place_[i]];
    const int size = static_cast<int>(nodes.size());
    fetch_ahead(nodes.data());
    // The centre comes first, unless another node lies there too.
    if (size < needed || nodes[0] != sites.anchor_node[anchors[i]]) continue;
    order_.add(size, static_cast<int>(i));
  }
  return order_.arrange();
}

template <int Dim>
template <class Treat>
void TaylorBatch<Dim>::each_part(std::span<const SizeOrder::Entry> ordered, Treat treat) {
  const std::size_t lanes = lanes_of(simd_path());
  const std::size_t count = ordered.size();
  for (std::size_t begin = 0, end = 0; begin < count; begin = end) {
    const int size = ordered[std::min(begin + lanes, count) - 1].size;
    for (end = begin; end < count;) {
      const std::size_t next = std::min(end + lanes, count);
      if (ordered[next - 1].size != size) break;
      end = next;
    }
    treat(ordered.subspan(begin, end - begin), size);
  }
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
  own_.clear();
  for (const MultiIndex<Dim>& alpha : derivatives) {
    orders_.push_back(order_of<Dim>(alpha));
    own_.push_back(orders_.back() == 0 ? -1 : basis.monomials().index(alpha));
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
TaylorStencils TaylorBatch<Dim>::prepare(const TaylorParts<Dim>& fit, const Sites<Dim>& sites,
                                         const double* anchors, const std::int64_t* offsets,
                                         const int* ids, int size) {
  const std::size_t lanes = lanes_of(simd_path());
  grow_to(z_, lanes * size * Dim);
  grow_to(rho_, lanes * size);
  grow_to(squared_, lanes * size);
  grow_to(done_, (chosen_.size() + lanes - 1) / lanes);
  return {{sites.nodes.data(), anchors, offsets, ids, chosen_.data(),
           static_cast<int>(chosen_.size()), size},
          Dim,
          fit.basis.degree(),
          fit.limits.least_pivot,
          fit.limits.condition,
          weights_of(fit.weight, sites.volumes.data()),
          z_.data(),
          rho_.data(),
          squared_.data()};
}

template <int Dim>
void TaylorBatch<Dim>::fill(const TaylorParts<Dim>& fit, const StencilBatch<Dim>& batch,
                            Weights& weights, std::span<LocalOutcome> outcomes) {
  const std::size_t lanes = lanes_of(simd_path());
  const int terms = fit.basis.terms();
  stencil_of_place_.assign(batch.anchors.begin(), batch.anchors.end());
  const auto by_size = ordered(batch.sites, batch.anchors, batch.stencils, terms + 1);
  tabulate(fit.basis, batch.derivatives);
  each_part(by_size, [&](std::span<const SizeOrder::Entry> part, int size) {
    chosen_.resize(part.size());
    for (std::size_t i = 0; i < part.size(); ++i) chosen_[i] = batch.anchors[part[i].place];
    grow_to(scratch_, taylor_scratch(size, terms, batch.derivatives.size(), lanes));
    fit_taylor(
        {prepare(fit, batch.sites, batch.sites.anchors.data(), batch.stencils.offsets.data(),
                 batch.stencils.nodes.data(), size),
         {batch.derivatives.size(), orders_.data(), factors_.data(), powers_.data(), own_.data()},
         {batch.sites.points.data(), batch.points.offsets.data(), batch.points.nodes.data(),
          weights.offsets.data(), weights.values.data()},
         weights.values.size() >= least_streamed ? Output::streamed : Output::cached,
         scratch_.data(),
         done_.data()});
    for (std::size_t i = 0; i < part.size(); i += lanes) {
      const unsigned done = done_[i / lanes];
      const std::size_t end = std::min(i + lanes, part.size());
      for (std::size_t j = i; j < end; ++j) {
        LocalOutcome& outcome = outcomes[part[j].place];
        outcome = (done >> (j - i) & 1U) != 0 ? LocalOutcome::ok : outcome;
      }
    }
  });
}

template <int Dim>
void TaylorBatch<Dim>::judge(const TaylorParts<Dim>& fit, const Sites<Dim>& sites,
                             std::span<const int> anchors, const Stencils& stencils, int first,
                             Scaling scaling, ConditionNorm norm,
                             std::span<ConditionBounds> bounds) {
  const std::size_t lanes = lanes_of(simd_path());
  const int terms = fit.basis.terms();
  stencil_of_place_.clear();
  origins_.clear();
  orders_.clear();
  factors_.clear();
  for (std::size_t i = 0; i < anchors.size(); ++i) {
    stencil_of_place_.push_back(first + static_cast<int>(i));
    for (int c = 0; c < Dim; ++c) origins_.push_back(sites.anchors(c, anchors[i]));
  }
  for (const MultiIndex<Dim>& monomial : fit.basis.monomials()) {
    factors_.push_back(1 / factorial<Dim>(monomial));
    orders_.push_back(scaling == Scaling::row ? order_of<Dim>(monomial) : 0);
  }
  derivatives_ = {};
  const auto by_size = ordered(sites, anchors, stencils, terms + 1);
  each_part(by_size, [&](std::span<const SizeOrder::Entry> part, int size) {
    chosen_.clear();
    for (const SizeOrder::Entry& entry : part) chosen_.push_back(entry.place);
    const std::size_t padded = (part.size() + lanes - 1) / lanes * lanes;
    grow_to(one_, padded);
    grow_to(maximum_, padded);
    judge_taylor({prepare(fit, sites, origins_.data(), stencils.offsets.data() + first,
                          stencils.nodes.data(), size),
                  factors_.data(), orders_.data(), one_.data(), maximum_.data(), done_.data()});
    for (std::size_t i = 0; i < part.size(); ++i) {
      if ((done_[i / lanes] >> (i % lanes) & 1U) == 0) continue;
      // |A|_2^2 <= |A|_1 |A|_max, and either is at most sqrt(m) |A|_2.
      bounds[part[i].place] = norm == ConditionNorm::one
                                  ? ConditionBounds{one_[i], one_[i]}
                                  : ConditionBounds{std::max(one_[i], maximum_[i]) / terms,
                                                    std::sqrt(one_[i] * maximum_[i])};
    }
  });
}

template class TaylorBatch<1>;
template class TaylorBatch<2>;
template class TaylorBatch<3>;

}  // namespace strongpoint
