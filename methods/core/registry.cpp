#include "methods/core/registry.hpp"

#include <utility>

namespace strongpoint {

#define METHOD(name) MethodEntry method_##name();
#include "methods/methods.def"
#undef METHOD
#define RULE(name) RuleEntry rule_##name();
#include "methods/rules/rules.def"
#undef RULE
#define WEIGHT(name) WeightEntry weight_##name();
#include "methods/weights/weights.def"
#undef WEIGHT

const std::vector<MethodEntry>& methods() {
  static const std::vector<MethodEntry> entries = {
#define METHOD(name) method_##name(),
#include "methods/methods.def"
#undef METHOD
  };
  return entries;
}

const std::vector<RuleEntry>& rules() {
  static const std::vector<RuleEntry> entries = {
#define RULE(name) rule_##name(),
#include "methods/rules/rules.def"
#undef RULE
  };
  return entries;
}

const std::vector<WeightEntry>& weight_functions() {
  static const std::vector<WeightEntry> entries = {
#define WEIGHT(name) weight_##name(),
#include "methods/weights/weights.def"
#undef WEIGHT
  };
  return entries;
}

template <int Dim>
Named<Method<Dim>> make_method(std::string_view text) {
  const Spec spec = parse_spec(text);
  const MethodEntry& entry = find_entry(methods(), "method", spec.name);
  Options options(entry.info, spec);
  std::unique_ptr<Method<Dim>> made = entry.factory.template make<Dim>(options);
  return {options.canonical(), std::move(made)};
}

template <int Dim>
Named<StencilRule<Dim>> make_rule(std::string_view text) {
  const Spec spec = parse_spec(text);
  const RuleEntry& entry = find_entry(rules(), "stencil rule", spec.name);
  Options options(entry.info, spec);
  std::unique_ptr<StencilRule<Dim>> made = entry.factory.template make<Dim>(options);
  return {options.canonical(), std::move(made)};
}

NamedWeight make_weight(std::string_view text) {
  const Spec spec = parse_spec(text);
  const WeightEntry& entry = find_entry(weight_functions(), "weight", spec.name);
  const Options options(entry.info, spec);
  return {options.canonical(), entry.make(options)};
}

template Named<Method<1>> make_method<1>(std::string_view);
template Named<Method<2>> make_method<2>(std::string_view);
template Named<Method<3>> make_method<3>(std::string_view);
template Named<StencilRule<1>> make_rule<1>(std::string_view);
template Named<StencilRule<2>> make_rule<2>(std::string_view);
template Named<StencilRule<3>> make_rule<3>(std::string_view);

}  // namespace strongpoint
