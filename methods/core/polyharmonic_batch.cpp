#include "methods/core/polyharmonic_batch.hpp"

#include <algorithm>
#include <numeric>

#include "methods/core/radial_derivative.hpp"

namespace strongpoint {

template <int Dim>
void PolyharmonicBatch<Dim>::prepare(int phs, const Derivatives<Dim>& monomials,
                                     const Derivatives<Dim>& derivatives) {
  if (prepared_ == derivatives) return;
  prepared_ = derivatives;
  exponents_.clear();
  orders_.clear();
  factors_.clear();
  radial_.clear();
  radial_offsets_.assign(1, 0);
  for (const MultiIndex<Dim>& a : monomials)
    exponents_.insert(exponents_.end(), a.begin(), a.end());
  for (const MultiIndex<Dim>& d : derivatives) {
    orders_.insert(orders_.end(), d.begin(), d.end());
    for (const MultiIndex<Dim>& a : monomials) {
      MultiIndex<Dim> left{};
      bool vanishes = false;
      for (int c = 0; c < Dim; ++c) {
        left[c] = std::max(0, a[c] - d[c]);
        vanishes = vanishes || a[c] < d[c];
      }
      factors_.push_back(vanishes ? 0 : factorial<Dim>(a) / factorial<Dim>(left));
    }
    const RadialDerivative<Dim> of_power(d);
    for (const auto& term : of_power.terms()) {
      RadialTerm& made = radial_.emplace_back(RadialTerm{term.coefficient, {}, term.outer});
      std::copy(term.exponents.begin(), term.exponents.end(), made.exponents);
    }
    radial_offsets_.push_back(static_cast<int>(radial_.size()));
  }
  task_.dimension = Dim;
  task_.phs = phs;
  task_.terms = monomials.size();
  task_.exponents = exponents_.data();
  task_.derivatives = derivatives.size();
  task_.orders = orders_.data();
  task_.radial = radial_.data();
  task_.radial_offsets = radial_offsets_.data();
  task_.factors = factors_.data();
}

template <int Dim>
void PolyharmonicBatch<Dim>::fill(const StencilBatch<Dim>& batch, Weights& weights,
                                  std::span<LocalOutcome> outcomes) {
  const auto size_of = [&](int i) {
    return static_cast<int>(batch.stencils[batch.anchors[i]].size());
  };
  const auto points_of = [&](int i) { return batch.points[batch.anchors[i]].size(); };
  order_.resize(batch.anchors.size());
  std::iota(order_.begin(), order_.end(), 0);
  std::sort(order_.begin(), order_.end(), [&](int a, int b) {
    if (size_of(a) != size_of(b)) return size_of(a) < size_of(b);
    return points_of(a) != points_of(b) ? points_of(a) < points_of(b) : a < b;
  });
  for (auto begin = order_.begin(); begin != order_.end();) {
    const int size = size_of(*begin);
    const auto end = std::find_if(begin, order_.end(), [&](int i) { return size_of(i) != size; });
    if (size >= task_.terms && task_.derivatives > 0) {
      chosen_.clear();
      for (auto i = begin; i != end; ++i) chosen_.push_back(batch.anchors[*i]);
      served_.assign(chosen_.size(), 0);
      task_.table = {.nodes = batch.sites.nodes.data(),
                     .anchors = batch.sites.anchors.data(),
                     .offsets = batch.stencils.offsets.data(),
                     .ids = batch.stencils.nodes.data(),
                     .chosen = chosen_.data(),
                     .count = static_cast<int>(chosen_.size()),
                     .size = size};
      task_.points = batch.sites.points.data();
      task_.spans = batch.sites.spans.cols() > 0 ? batch.sites.spans.data() : nullptr;
      task_.point_offsets = batch.points.offsets.data();
      task_.point_ids = batch.points.nodes.data();
      task_.values = weights.values.data();
      task_.value_offsets = weights.offsets.data();
      task_.served = served_.data();
      room_.resize(
          std::max(room_.size(), polyharmonic_room(Dim, size, task_.terms, task_.derivatives)));
      task_.room = room_.data();
      polyharmonic_weights(task_);
      for (std::size_t i = 0; i < chosen_.size(); ++i) {
        if (served_[i] != 0) outcomes[begin[static_cast<std::ptrdiff_t>(i)]] = LocalOutcome::ok;
      }
    }
    begin = end;
  }
}

template class PolyharmonicBatch<1>;
template class PolyharmonicBatch<2>;
template class PolyharmonicBatch<3>;

}  // namespace strongpoint
