#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "methods/core/method.hpp"
#include "methods/core/options.hpp"
#include "methods/core/rule.hpp"
#include "methods/core/weight_function.hpp"

namespace strongpoint {

/// One maker per space dimension of a thing that exists in all three.
template <template <int> class Made>
struct Factory {
  std::unique_ptr<Made<1>> (*in_1d)(Options& options);
  std::unique_ptr<Made<2>> (*in_2d)(Options& options);
  std::unique_ptr<Made<3>> (*in_3d)(Options& options);

  template <int Dim>
  std::unique_ptr<Made<Dim>> make(Options& options) const {
    if constexpr (Dim == 1) return in_1d(options);
    if constexpr (Dim == 2) return in_2d(options);
    if constexpr (Dim == 3) return in_3d(options);
  }
};

/// A factory from a stateless generic lambda `[]<int Dim>(Dimension<Dim>, Options&)`. A maker may
/// replace nested specs among the options by their canonical form.
template <template <int> class Made, class Maker>
Factory<Made> in_every_dimension(Maker) {
  return {[](Options& o) -> std::unique_ptr<Made<1>> { return Maker{}(Dimension<1>{}, o); },
          [](Options& o) -> std::unique_ptr<Made<2>> { return Maker{}(Dimension<2>{}, o); },
          [](Options& o) -> std::unique_ptr<Made<3>> { return Maker{}(Dimension<3>{}, o); }};
}

/// A registered method.
struct MethodEntry {
  EntryInfo info;
  Factory<Method> factory;
};

/// A registered stencil rule.
struct RuleEntry {
  EntryInfo info;
  Factory<StencilRule> factory;
};

/// A thing made from a spec, with the spec's canonical form.
template <class Made>
struct Named {
  std::string spec;
  std::unique_ptr<Made> made;
};

/// All registered methods, in the order of methods.def.
const std::vector<MethodEntry>& methods();
/// All registered stencil rules, in the order of rules.def.
const std::vector<RuleEntry>& rules();
/// All registered weight functions, in the order of weights.def.
const std::vector<WeightEntry>& weight_functions();

/// Makes a method from its spec. Throws UsageError for unknown names, options and values.
template <int Dim>
Named<Method<Dim>> make_method(std::string_view spec);
/// Makes a stencil rule from its spec. Throws UsageError for unknown names, options and values.
template <int Dim>
Named<StencilRule<Dim>> make_rule(std::string_view spec);

/// A weight function with its canonical spec.
struct NamedWeight {
  std::string spec;
  std::shared_ptr<const WeightFunction> made;
};
/// Makes a weight function from its spec. Throws UsageError for unknown names, options and values.
NamedWeight make_weight(std::string_view spec);

}  // namespace strongpoint
