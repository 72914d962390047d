#include "methods/core/simd/taylor_condition.hpp"

#include "methods/core/simd/lane_ldlt.hpp"
#include "methods/core/simd/lane_monomials.hpp"
#include "methods/core/simd/lane_weights.hpp"

namespace strongpoint::STRONGPOINT_SIMD_PATH {
namespace {

struct Norms {
  Pack one, maximum;
};

/// Norms of a symmetric matrix whose columns are multiplied by factors.
template <int Size>
Norms norms_of_scaled(const Pack* lower, const Pack* factors) {
  Norms norms{all(0), all(0)};
  for (int i = 0; i < Size; ++i) {
    Pack plain = all(0);
    Pack scaled = all(0);
    for (int j = 0; j < Size; ++j) {
      const Pack entry = abs(lower[i > j ? triangle(i, j) : triangle(j, i)]);
      plain = plain + entry;
      scaled = scaled + entry * factors[j];
    }
    norms.one = max(norms.one, plain * factors[i]);
    norms.maximum = max(norms.maximum, scaled);
  }
  return norms;
}

template <int Dim, int Order>
unsigned judge_group(const TaylorConditionTask& task, int first) {
  constexpr int terms = monomials_up_to<Dim>(Order);
  const int size = task.stencils.table.size;
  LaneStencils group;
  const Pack* const weights = gather_weighed<Dim>(task.stencils, first, group);
  Pack moments[terms * (terms + 1) / 2];
  Pack inverse[terms * (terms + 1) / 2];
  if (weights == nullptr) {
    sum_moments<Dim, Order>(group.z, EqualWeights{}, size, moments);
  } else {
    sum_moments<Dim, Order>(group.z, weights, size, moments);
  }
  Pack factors[terms];
  Pack inverse_factors[terms];
  for (int a = 0; a < terms; ++a) {
    factors[a] = all(task.columns[a]);
    for (int q = 0; q < task.powers[a]; ++q) factors[a] = factors[a] * group.radius;
    inverse_factors[a] = all(1) / factors[a];
  }
  const Pack plain = norm_of_symmetric<terms>(moments);
  const Norms norms = norms_of_scaled<terms>(moments, factors);
  const unsigned good = factorise_ldlt<terms>(moments, task.stencils.least_pivot);
  InverseFactors<terms> factors_of_inverse;
  factors_of_inverse.take(moments);
  factors_of_inverse.multiply(inverse);
  // Rows of the inverse are divided by the factors: the norms change places.
  const Norms of_inverse = norms_of_scaled<terms>(inverse, inverse_factors);
  store(task.one + first, norms.one * of_inverse.maximum);
  store(task.maximum + first, norms.maximum * of_inverse.one);
  return good & ~group.coincident &
         less(plain * norm_of_symmetric<terms>(inverse), all(task.stencils.limit));
}

template <int Dim, int Order>
void judge(const TaylorConditionTask& task) {
  for (int first = 0; first < task.stencils.table.count; first += lanes) {
    task.done[first / lanes] = judge_group<Dim, Order>(task, first);
  }
}

template <int Dim>
void judge_any_order(const TaylorConditionTask& task) {
  switch (task.stencils.order) {
    case 1:
      return judge<Dim, 1>(task);
    case 2:
      return judge<Dim, 2>(task);
    case 3:
      return judge<Dim, 3>(task);
    default:
      if constexpr (Dim < 3) judge<Dim, 4>(task);
  }
}

}  // namespace

void judge_taylor(const TaylorConditionTask& task) {
  switch (task.stencils.dim) {
    case 1:
      return judge_any_order<1>(task);
    case 2:
      return judge_any_order<2>(task);
    default:
      return judge_any_order<3>(task);
  }
}

}  // namespace strongpoint::STRONGPOINT_SIMD_PATH
