#include <algorithm>

#include "methods/core/index_differences.hpp"
#include "methods/core/registry.hpp"

namespace strongpoint {
namespace {

/// Drops the entries whose weights are all zero.
Weights without_zeros(Weights weights) {
  const int m = weights.per_entry;
  std::int64_t kept = 0;
  std::int64_t begin = 0;
  for (int p = 0; p < weights.size(); ++p) {
    const std::int64_t end = weights.offsets[p + 1];
    for (std::int64_t e = begin; e < end; ++e) {
      const auto values = weights.values.begin() + e * m;
      if (std::all_of(values, values + m, [](double w) { return w == 0; })) continue;
      weights.columns[kept] = weights.columns[e];
      std::copy(values, values + m, weights.values.begin() + kept * m);
      ++kept;
    }
    begin = end;
    weights.offsets[p + 1] = kept;
  }
  weights.columns.resize(kept);
  weights.values.resize(kept * m);
  return weights;
}

/// Index differences whose rows hold only the nodes that carry a weight.
template <int Dim>
class FiniteDifferences final : public LocalMethod<Dim, IndexDifferences<Dim>> {
 public:
  using LocalMethod<Dim, IndexDifferences<Dim>>::LocalMethod;
  Weights weights(const Sites<Dim>& sites, const Stencils& stencils,
                  const Derivatives<Dim>& derivatives) const override {
    return without_zeros(
        LocalMethod<Dim, IndexDifferences<Dim>>::weights(sites, stencils, derivatives));
  }
};

}  // namespace

/// Finite differences on structured clouds, wherever the nodes lie: see IndexDifferences. Even
/// orders are the natural ones: an odd order is met at the boundary, and inside the differences are
/// those of the next even one. Source: Fornberg 1988.
MethodEntry method_fdm() {
  return {{"fdm",
           "finite differences along the index lines of a structured cloud",
           {{"order", "2", "order of accuracy of first and second derivatives, 1 to 8"}}},
          in_every_dimension<Method>(
              []<int Dim>(Dimension<Dim>, Options& options) -> std::unique_ptr<Method<Dim>> {
                const int order = options.integer("order", 1, 8);
                IndexDifferences<Dim> differences(order);
                const int size = differences.needed_nodes();
                const std::string rule = fmt::format("block[width={}]", differences.width());
                return std::make_unique<FiniteDifferences<Dim>>(
                    std::move(differences),
                    typename FiniteDifferences<Dim>::Traits{
                        "fdm", {.reproduces = order}, {.block = true, .centre = true}, size, rule});
              })};
}

}  // namespace strongpoint
