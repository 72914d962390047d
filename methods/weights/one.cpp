#include <algorithm>

#include "methods/core/weight_function.hpp"

namespace strongpoint {
namespace {

class One final : public WeightFunction {
 public:
  bool is_one() const override { return true; }
  void squared(std::span<const double>, std::span<double> result) const override {
    std::fill(result.begin(), result.end(), 1.0);
  }
};

}  // namespace

/// T = 1: the plain least-squares fit of the novel MFPM. Source: thesis 3.2.
WeightEntry weight_one() {
  return {{"one", "T = 1, all nodes count alike", {}},
          [](const Options&) -> std::shared_ptr<const WeightFunction> {
            return std::make_shared<One>();
          }};
}

}  // namespace strongpoint
