#include "methods/core/registry.hpp"

namespace strongpoint {
namespace {

template <int Dim>
class Nearest final : public StencilRule<Dim> {
 public:
  Nearest(int k, Ties ties) : k_(k), ties_(ties) {}

  Stencils select(const Sites<Dim>& sites, std::span<const int> anchors, const Method<Dim>& method,
                  const NeighbourSearch<Dim>& search) const override {
    const int k = k_ > 0 ? k_ : method.stencil_size();
    return nearest_to_anchors(sites, anchors, k, ties_, search);
  }

 private:
  int k_;  ///< 0: what the method's order needs
  Ties ties_;
};

}  // namespace

/// The nearest nodes, the centre included. Source: thesis 3.2.1 (ties with the last node kept).
RuleEntry rule_nearest() {
  return {{"nearest",
           "the k nearest nodes",
           {{"k", "", "nodes, the centre included; what the method's order needs when not given"},
            {"ties", "keep", "keep | cut: nodes as far away as the last one (1e-9, relative)"}}},
          in_every_dimension<StencilRule>(
              []<int Dim>(Dimension<Dim>, Options& options) -> std::unique_ptr<StencilRule<Dim>> {
                const int k = options.has("k") ? options.integer("k", 1, 100000) : 0;
                return std::make_unique<Nearest<Dim>>(
                    k, options.choice<Ties>("ties", {{"keep", Ties::keep}, {"cut", Ties::cut}}));
              })};
}

}  // namespace strongpoint
