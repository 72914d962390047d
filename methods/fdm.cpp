#include <algorithm>

#include "methods/core/index_differences.hpp"
#include "methods/core/mapped_differences.hpp"
#include "methods/core/registry.hpp"

namespace strongpoint {
namespace {

/// Width of the rule block that takes lines as a whole: the largest it knows.
constexpr int widest_block = 101;

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

/// Differences whose rows hold only the nodes that carry a weight.
template <int Dim, class Kernel>
class FiniteDifferences final : public LocalMethod<Dim, Kernel> {
 public:
  using LocalMethod<Dim, Kernel>::LocalMethod;
  Weights weights(const Sites<Dim>& sites, const Stencils& stencils,
                  const Derivatives<Dim>& derivatives) const override {
    return without_zeros(LocalMethod<Dim, Kernel>::weights(sites, stencils, derivatives));
  }
};

/// What the differences are exact for: polynomials in space, or in the block's coordinates.
enum class Exact { physical, mapped };

template <int Dim, class Kernel>
std::unique_ptr<Method<Dim>> make_differences(Kernel kernel, int degree, int width) {
  const int size = kernel.needed_nodes();
  return std::make_unique<FiniteDifferences<Dim, Kernel>>(
      std::move(kernel),
      typename FiniteDifferences<Dim, Kernel>::Traits{"fdm",
                                                      {.reproduces = degree},
                                                      {.block = true, .centre = true},
                                                      size,
                                                      fmt::format("block[width={}]", width)});
}

template <int Dim>
std::unique_ptr<Method<Dim>> make_fdm(const Options& options) {
  const Exact exact =
      options.choice<Exact>("exact", {{"physical", Exact::physical}, {"mapped", Exact::mapped}});
  if (exact == Exact::physical && options.text("order") != "spectral") {
    IndexDifferences<Dim> differences(options.integer("order", 1, 8));
    const int width = differences.width();
    return make_differences<Dim>(std::move(differences), options.integer("order", 1, 8), width);
  }
  if (exact == Exact::physical) {
    throw UsageError(options.where("order") + "=spectral needs exact=mapped");
  }
  const bool is_whole = options.text("order") == "spectral";
  MappedDifferences<Dim> differences(
      is_whole ? whole_line : options.integer("order", 2, MappedDifferences<Dim>::most));
  const int width = is_whole ? widest_block : differences.width();
  return make_differences<Dim>(std::move(differences), 1, width);
}

}  // namespace

/// Finite differences on structured clouds, wherever the nodes lie: see IndexDifferences and, for
/// smooth maps, MappedDifferences. Even orders are the natural ones of the first: an odd order is
/// met at the boundary, and inside the differences are those of the next even one. Source:
/// Fornberg 1988.
MethodEntry method_fdm() {
  return {{"fdm",
           "finite differences along the index lines of a structured cloud",
           {{"order", "2",
             "of accuracy of first and second derivatives, 1 to 8; with exact=mapped the degree "
             "along a line, 2 to 16, or spectral: that of the whole line"},
            {"exact", "physical",
             "physical | mapped: for polynomials in space, or in the coordinates of the block, "
             "which takes a smooth map"}}},
          in_every_dimension<Method>(
              []<int Dim>(Dimension<Dim>, Options& options) -> std::unique_ptr<Method<Dim>> {
                return make_fdm<Dim>(options);
              })};
}

}  // namespace strongpoint
