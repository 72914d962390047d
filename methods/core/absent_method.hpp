#pragma once

#include <string>
#include <utility>
#include <vector>

#include "methods/core/error.hpp"
#include "methods/core/method.hpp"

namespace strongpoint {

/// Stands for a method in a dimension where it does not exist: it says why, whatever is asked for.
template <int Dim>
class AbsentMethod final : public Method<Dim> {
 public:
  explicit AbsentMethod(std::string reason) : reason_(std::move(reason)) {}

  Promises promises() const override { return {}; }
  int stencil_size() const override { return 1; }
  std::string unsupported(const Derivatives<Dim>&) const override { return reason_; }
  Weights weights(const Sites<Dim>&, const Stencils&, const Derivatives<Dim>&) const override {
    throw CaseError(reason_);
  }
  std::vector<double> condition(const Sites<Dim>&, std::span<const int>, const Stencils&, Scaling,
                                ConditionNorm) const override {
    throw CaseError(reason_);
  }

 private:
  std::string reason_;
};

}  // namespace strongpoint
