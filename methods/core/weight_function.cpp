#include "methods/core/weight_function.hpp"

#include "methods/core/simd/weight_kernel.hpp"

namespace strongpoint {

std::shared_ptr<const WeightFunction> weight_of_formula(const WeightFormula& formula) {
  class Formulated final : public WeightFunction {
   public:
    explicit Formulated(const WeightFormula& made) : formula_(made) {}
    const WeightFormula* formula() const override { return &formula_; }
    void squared(std::span<const double> rho, std::span<double> result) const override {
      weigh_distances({&formula_, rho.data(), result.data(), static_cast<long>(rho.size())});
    }

   private:
    WeightFormula formula_;
  };
  return std::make_shared<Formulated>(formula);
}

}  // namespace strongpoint
