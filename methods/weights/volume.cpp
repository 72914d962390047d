#include "methods/core/weight_function.hpp"

namespace strongpoint {
namespace {

class CellVolume final : public WeightFunction {
 public:
  bool uses_volumes() const override { return true; }
  void squared(std::span<const double>, std::span<double>) const override {
    throw std::logic_error("the weight 'volume' is read from the sites, not from distances");
  }
};

}  // namespace

/// T^2 = the measure of the node's cell: the quadrature of the original MFPM. Source: thesis (3.7).
WeightEntry weight_volume() {
  return {{"volume", "T^2 = measure of the node's Voronoi cell", {}},
          [](const Options&) -> std::shared_ptr<const WeightFunction> {
            return std::make_shared<CellVolume>();
          }};
}

}  // namespace strongpoint
