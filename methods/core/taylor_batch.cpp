#include "methods/core/taylor_batch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "methods/core/simd/taylor_condition.hpp"

namespace strongpoint {
namespace {

/// Numbers of gathered stencils that are weighed at a time: they stay near, and what a call of a
/// kernel costs is shared by many.
constexpr std::size_t gathered_at_a_time = 12288;

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

}  // namespace

template <int Dim>
void TaylorBatch<Dim>::sort_by_size(const Sites<Dim>& sites, std::span<const int> anchors,
                                    const Stencils& stencils, int needed) {
  by_size_.resize(anchors.size());
  std::size_t count = 0;
  bool sorted = true;
  int before = 0;
  for (std::size_t i = 0; i < anchors.size(); ++i) {
    const std::span<const int> nodes = stencils[stencil_of_place_[i]];
    const int size = static_cast<int>(nodes.size());
    fetch_ahead(nodes.data());
    // The centre comes first, unless another node lies there too.
    if (size < needed || nodes[0] != sites.anchor_node[anchors[i]]) continue;
    sorted = sorted && before <= size;
    before = size;
    by_size_[count++] = {size, static_cast<int>(i)};
  }
  by_size_.resize(count);
  if (!sorted) std::sort(by_size_.begin(), by_size_.end());
}

template <int Dim>
template <class Treat>
void TaylorBatch<Dim>::each_part(std::size_t numbers, Treat treat) {
  const std::size_t lanes = lanes_of(simd_path());
  const std::size_t count = by_size_.size();
  for (std::size_t begin = 0, end = 0; begin < count; begin = end) {
    const int size = by_size_[std::min(begin + lanes, count) - 1].first;
    const std::size_t most = std::max<std::size_t>(1, numbers / (lanes * size * (Dim + 2)));
    end = begin;
    for (std::size_t group = 0; group < most && end < count; ++group) {
      const std::size_t next = std::min(end + lanes, count);
      if (by_size_[next - 1].first != size) break;
      end = next;
    }
    treat(std::span<const Sized>(by_size_.data() + begin, end - begin));
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
GatherTask TaylorBatch<Dim>::prepare(const StencilTable& table, std::size_t room,
                                     const WeightFunction& weight) {
  const std::size_t lanes = lanes_of(simd_path());
  const std::size_t groups = (table.count + lanes - 1) / lanes;
  grow_to(z_, room * lanes * table.size * Dim);
  grow_to(rho_, room * lanes * table.size);
  grow_to(radius_, groups * lanes);
  grow_to(faulty_, groups);
  grow_to(done_, groups);
  return {table,
          Dim,
          weight.uses_volumes() || weight.is_one() ? Distances::squares : Distances::roots,
          z_.data(),
          rho_.data(),
          radius_.data(),
          faulty_.data()};
}

template <int Dim>
GatherTask TaylorBatch<Dim>::gather(const Sites<Dim>& sites, const StencilTable& table,
                                    const WeightFunction& weight) {
  const std::size_t lanes = lanes_of(simd_path());
  const std::size_t size = table.size;
  const std::size_t groups = (table.count + lanes - 1) / lanes;
  const GatherTask task = prepare(table, groups, weight);
  gather_stencils(task);
  if (weight.is_one()) return task;
  for (std::size_t group = 0; group < groups; ++group) {  // the centre's distance does not count
    double* const centre = rho_.data() + group * lanes * size;
    std::fill(centre, centre + lanes, 1.0);
  }
  grow_to(squared_, groups * lanes * size);
  weigh(sites, task, weight);
  return task;
}

template <int Dim>
void TaylorBatch<Dim>::weigh(const Sites<Dim>& sites, const GatherTask& task,
                             const WeightFunction& weight) {
  const std::size_t lanes = lanes_of(simd_path());
  const StencilTable& table = task.table;
  const std::size_t size = table.size;
  const std::size_t count = (chosen_.size() + lanes - 1) / lanes * lanes * size;
  if (!weight.uses_volumes()) {
    weight.squared({rho_.data(), count}, {squared_.data(), count});
    return;
  }
  std::fill_n(squared_.begin(), count, 0.0);
  for (std::size_t i = 0; i < chosen_.size(); ++i) {
    const double unit = std::pow(radius_[i], -Dim);
    double* next = squared_.data() + i / lanes * lanes * size + i % lanes;
    for (std::int64_t e = table.offsets[chosen_[i]]; e < table.offsets[chosen_[i] + 1]; ++e) {
      *next = sites.volumes[table.ids[e]] * unit;
      next += lanes;
    }
  }
}

template <int Dim>
void TaylorBatch<Dim>::fill(const TaylorParts<Dim>& fit, const StencilBatch<Dim>& batch,
                            Weights& weights, std::span<LocalOutcome> outcomes) {
  const std::size_t lanes = lanes_of(simd_path());
  const int terms = fit.basis.terms();
  stencil_of_place_.assign(batch.anchors.begin(), batch.anchors.end());
  sort_by_size(batch.sites, batch.anchors, batch.stencils, terms + 1);
  tabulate(fit.basis, batch.derivatives);
  // Without weights a kernel gathers each group when it comes to it.
  const bool weighs = !fit.weight.is_one();
  each_part(
      weighs ? gathered_at_a_time : std::numeric_limits<std::size_t>::max(),
      [&](std::span<const Sized> part) {
        const int size = part.back().first;
        chosen_.resize(part.size());
        for (std::size_t i = 0; i < part.size(); ++i) chosen_[i] = batch.anchors[part[i].second];
        grow_to(scratch_, taylor_scratch(size, terms, batch.derivatives.size(), lanes));
        const StencilTable table{batch.sites.nodes.data(),
                                 batch.sites.anchors.data(),
                                 batch.stencils.offsets.data(),
                                 batch.stencils.nodes.data(),
                                 chosen_.data(),
                                 static_cast<int>(chosen_.size()),
                                 size};
        fit_taylor({weighs ? gather(batch.sites, table, fit.weight) : prepare(table, 1, fit.weight),
                    fit.basis.degree(),
                    fit.limits.least_pivot,
                    fit.limits.condition,
                    weighs ? squared_.data() : nullptr,
                    {batch.derivatives.size(), orders_.data(), factors_.data(), powers_.data(),
                     own_.data()},
                    {batch.sites.points.data(), batch.points.offsets.data(),
                     batch.points.nodes.data(), weights.offsets.data(), weights.values.data()},
                    weights.values.size() >= least_streamed ? Output::streamed : Output::cached,
                    scratch_.data(),
                    done_.data()});
        for (std::size_t i = 0; i < part.size(); i += lanes) {
          const unsigned done = done_[i / lanes];
          const std::size_t end = std::min(i + lanes, part.size());
          for (std::size_t j = i; j < end; ++j) {
            LocalOutcome& outcome = outcomes[part[j].second];
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
  sort_by_size(sites, anchors, stencils, terms + 1);
  each_part(gathered_at_a_time, [&](std::span<const Sized> part) {
    const int size = part.back().first;
    chosen_.clear();
    for (const auto& [ignored, place] : part) chosen_.push_back(place);
    const std::size_t padded = (part.size() + lanes - 1) / lanes * lanes;
    grow_to(scratch_, lanes * size);
    grow_to(one_, padded);
    grow_to(maximum_, padded);
    judge_taylor(
        {gather(sites,
                {sites.nodes.data(), origins_.data(), stencils.offsets.data() + first,
                 stencils.nodes.data(), chosen_.data(), static_cast<int>(chosen_.size()), size},
                fit.weight),
         fit.basis.degree(), fit.limits.least_pivot, fit.limits.condition,
         fit.weight.is_one() ? nullptr : squared_.data(), factors_.data(), orders_.data(),
         scratch_.data(), one_.data(), maximum_.data(), done_.data()});
    for (std::size_t i = 0; i < part.size(); ++i) {
      if ((done_[i / lanes] >> (i % lanes) & 1U) == 0) continue;
      // |A|_2^2 <= |A|_1 |A|_max, and either is at most sqrt(m) |A|_2.
      bounds[part[i].second] = norm == ConditionNorm::one
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
