#pragma once

#include <algorithm>
#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "problems/core/grading.hpp"
#include "problems/core/layout.hpp"

namespace strongpoint {

/// What a layout multiplies its spacing by at a position.
template <int Dim>
using SpacingFactor = std::function<double(const Point<Dim>&)>;

/// Documents the options of a layout whose spacing can shrink towards features of the domain,
/// after the layout's own.
inline std::vector<OptionDoc> with_grading_options(std::vector<OptionDoc> own) {
  own.push_back({"toward", "",
                 "corners, curves or faces of the domain to concentrate nodes at, joined by '+', "
                 "such as corners or hole"});
  own.push_back(
      {"grade", "", "spacing there over the spacing far away, 0.001 to 1; 0.1 if left out"});
  own.push_back({"reach", "",
                 "distance from there on which the spacing is as without; 0.4 of the length along "
                 "which a level counts if left out"});
  return own;
}

/// The feature of a name. Throws SkipCase, listing the known ones, when the domain has none such.
template <int Dim>
Feature<Dim> find_feature(const std::vector<Feature<Dim>>& features, const std::string& name) {
  std::string known;
  for (const Feature<Dim>& feature : features) {
    if (feature.name == name) return feature;
    known += (known.empty() ? "" : ", ") + feature.name;
  }
  throw SkipCase(
      fmt::format("toward={}: the domain has nothing of this name; {}", name,
                  known.empty() ? "it names nothing, leave the option out" : "known: " + known));
}

/// The factor that the options ask for; empty when they ask for none. Throws UsageError for options
/// that do not fit and SkipCase for unknown features.
template <int Dim>
SpacingFactor<Dim> grading_of(const Options& options, const Domain<Dim>& domain) {
  if (!options.has("toward")) {
    for (const char* key : {"grade", "reach"}) {
      if (!options.has(key)) continue;
      throw UsageError(fmt::format("{} needs toward=NAME: say where the nodes are concentrated",
                                   options.where(key)));
    }
    return {};
  }
  // Finer than a thousandth the nodes of a cloud would all sit at one place.
  const Grading grading{options.has("grade") ? options.number("grade", 1e-3, 1) : 0.1,
                        options.has("reach")
                            ? options.number("reach", std::numeric_limits<double>::min(),
                                             std::numeric_limits<double>::max())
                            : 0.4 * domain.reference_length()};
  const std::vector<Feature<Dim>> known = domain.features();
  std::vector<Feature<Dim>> chosen;
  const std::string& names = options.text("toward");
  for (std::size_t start = 0; start <= names.size();) {
    const std::size_t end = std::min(names.find('+', start), names.size());
    chosen.push_back(find_feature(known, names.substr(start, end - start)));
    start = end + 1;
  }
  return [grading, chosen = std::move(chosen)](const Point<Dim>& x) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const Feature<Dim>& feature : chosen) nearest = std::min(nearest, feature.distance(x));
    return grading.factor(nearest);
  };
}

}  // namespace strongpoint
