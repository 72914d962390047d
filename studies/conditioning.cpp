#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "methods/core/parts.hpp"
#include "studies/support/stencil_quality.hpp"
#include "studies/support/study.hpp"
#include "studies/support/vtk.hpp"

namespace strongpoint {
namespace {

/// The anchors that a row speaks of.
struct ZoneChoice {
  const char* name;
  std::optional<Zone> zone;  ///< none: every anchor
};
constexpr std::array<ZoneChoice, 3> zones{
    {{"all", std::nullopt}, {"interior", Zone::interior}, {"boundary", Zone::boundary}}};

constexpr std::array<std::pair<const char*, double Spread::*>, 4> statistics{
    {{"min", &Spread::least},
     {"median", &Spread::median},
     {"p99", &Spread::p99},
     {"max", &Spread::most}}};

constexpr const char* centre_sign = "centre_sign_wrong";

Scaling scaling_of(const Options& extra) {
  return extra.choice<Scaling>("scaling", {{"both", Scaling::both}, {"row", Scaling::row}});
}

/// Names of what every stencil is judged by; a condition scaled another way is another quantity.
std::vector<std::string> figure_names(const Options& extra) {
  const std::string suffix = scaling_of(extra) == Scaling::row ? "_row" : "";
  return {"condition_two" + suffix, "condition_one" + suffix, "lebesgue_1", "lebesgue_2",
          "residual"};
}

std::vector<std::string> quantities(const CaseKey& key, const Options& extra) {
  return with_problem<Problem>(key.problem, "registered", [&]<int Dim>(const Problem<Dim>&) {
    const std::string why = make_method<Dim>(key.method).made->unsupported({});
    if (!why.empty()) throw SkipCase(why);
    std::vector<std::string> names;
    for (std::size_t zone = 0; zone < zones.size(); ++zone) {
      for (const std::string& figure : figure_names(extra)) {
        for (const auto& [statistic, member] : statistics) {
          names.push_back(figure + "_" + statistic);
        }
      }
      names.emplace_back(centre_sign);
    }
    return names;
  });
}

/// Every derivative of order 1 and 2 that a method gives, and the value where that is not known.
template <int Dim>
Derivatives<Dim> judged(const Method<Dim>& method) {
  Derivatives<Dim> all;
  for (const MultiIndex<Dim>& alpha : Derivatives<Dim>::between_orders(0, 2)) {
    const bool known = order_of<Dim>(alpha) == 0 && method.promises().interpolates;
    if (!known && method.unsupported({alpha}).empty()) all.merge({alpha});
  }
  return all;
}

/// What is known of every stencil of a case.
struct Figures {
  std::vector<PerAnchor> spread;  ///< in the order of `figure_names`
  PerAnchor centres;              ///< of the Laplacian
};

/// Judges the stencils chosen and, as far as there are any, the weights made of them.
template <int Dim>
Figures judge(Discretisation<Dim>& scene, const Method<Dim>& method, Scaling scaling) {
  Figures figures;
  for (const ConditionNorm norm : {ConditionNorm::two, ConditionNorm::one}) {
    figures.spread.push_back(stencil_conditions<Dim>(scene, method, scaling, norm));
  }
  try {
    scene.weights = weights_by_part(method, scene.sites, scene.stencils, scene.derivatives);
  } catch (const CaseError& error) {
    figures.centres.reason = error.what();
    figures.spread.insert(figures.spread.end(), 3, figures.centres);
    return figures;
  }
  figures.spread.push_back(lebesgue_numbers<Dim>(scene, 1));
  figures.spread.push_back(lebesgue_numbers<Dim>(scene, 2));
  figures.spread.push_back(reproduction_residuals<Dim>(scene, method.promises().reproduces));
  figures.centres = laplacian_centres<Dim>(scene);
  return figures;
}

/// The numbers of one zone.
std::vector<double> numbers_in(const PerAnchor& figure, const std::vector<Zone>& zone_of,
                               const std::optional<Zone>& zone) {
  std::vector<double> numbers;
  for (std::size_t a = 0; a < figure.values.size(); ++a) {
    if (!zone || zone_of[a] == *zone) numbers.push_back(figure.values[a]);
  }
  return numbers;
}

/// Why a zone has no numbers; empty when it has.
std::string gap(const PerAnchor& figure, const std::vector<double>& numbers) {
  if (!figure.reason.empty()) return figure.reason;
  return numbers.empty() ? "no node lies in this zone" : "";
}

/// The rows of one figure in one zone. An infinite condition is told as such.
void append_spread(const std::string& name, const ZoneChoice& zone, const PerAnchor& figure,
                   const std::vector<double>& numbers, std::vector<Quantity>& result) {
  const std::string why = gap(figure, numbers);
  const auto infinite = std::count_if(numbers.begin(), numbers.end(),
                                      [](double number) { return std::isinf(number); });
  const Spread spread = why.empty() ? spread_of(numbers) : Spread{};
  for (const auto& [statistic, member] : statistics) {
    Quantity quantity{fmt::format("{}_{}", name, statistic), spread.*member, why, {zone.name}};
    if (!why.empty()) quantity.value.reset();
    if (quantity.value && std::isinf(*quantity.value)) {
      quantity.value.reset();
      quantity.reason =
          fmt::format("infinite: {} of {} stencils have a singular local matrix, or none", infinite,
                      numbers.size());
    }
    result.push_back(std::move(quantity));
  }
}

std::vector<Quantity> told(const Figures& figures, const std::vector<std::string>& names,
                           const std::vector<Zone>& zone_of) {
  std::vector<Quantity> result;
  for (const ZoneChoice& zone : zones) {
    for (std::size_t f = 0; f < names.size(); ++f) {
      append_spread(names[f], zone, figures.spread[f],
                    numbers_in(figures.spread[f], zone_of, zone.zone), result);
    }
    const std::vector<double> centres = numbers_in(figures.centres, zone_of, zone.zone);
    Quantity sign{centre_sign, {}, gap(figures.centres, centres), {zone.name}};
    if (sign.reason.empty()) {
      const auto wrong = std::count_if(centres.begin(), centres.end(),
                                       [](double centre) { return !(centre < 0); });
      sign.value = static_cast<double>(wrong) / static_cast<double>(centres.size());
    }
    result.push_back(std::move(sign));
  }
  return result;
}

template <int Dim>
void write_map(const RunOptions& options, const CaseKey& key, const Discretisation<Dim>& scene,
               const Method<Dim>& method, const Figures& figures, const Options& extra) {
  const std::vector<std::string> names = figure_names(extra);
  std::vector<NodeArray> arrays;
  const auto add = [&](const std::string& name, const PerAnchor& figure) {
    if (figure.reason.empty()) arrays.push_back(scalar_array(name, figure.values));
  };
  for (std::size_t f = 0; f < names.size(); ++f) add(names[f], figures.spread[f]);
  add("laplacian_centre", figures.centres);
  add("stencil_size", stencil_sizes<Dim>(scene, method));
  arrays.push_back(zone_array(scene.sites.anchor_zone));
  VtkOutput output = *options.vtk;
  if (scaling_of(extra) == Scaling::row) output.study += "_row";  // beside the map of `both`
  write_vtu<Dim>(output, key, scene.cloud, arrays);
}

template <int Dim>
CaseResult run(const Problem<Dim>& problem, const CaseKey& key, const RunOptions& options,
               const Options& extra) {
  CaseResult result;
  const StageClock clock(options.threads);
  const Choices<Dim> choices(key);
  Discretisation<Dim> scene;
  scene.derivatives = judged(*choices.method);
  scene.cloud = make_case_cloud<Dim>(problem.domain(), key, options);
  scene.sites = sites_of_cloud<Dim>(scene.cloud);
  choose_stencils<Dim>(scene, problem.domain(), choices, options, clock, result.times);
  const Figures figures = judge<Dim>(scene, *choices.method, scaling_of(extra));
  if (options.vtk) write_map<Dim>(options, key, scene, *choices.method, figures, extra);
  result.quantities = told(figures, figure_names(extra), scene.sites.anchor_zone);
  result.nodes = scene.cloud.size();
  result.spacing = scene.cloud.spacing();
  return result;
}

}  // namespace
}  // namespace strongpoint

/// How well posed the local systems are that a method makes of a cloud: conditions, amplification
/// of errors, reproduction of polynomials and the sign of the Laplacian's centre, stencil by
/// stencil at every node, whatever the problem's equations read there.
int main(int argc, char** argv) {
  using namespace strongpoint;  // NOLINT(google-build-using-namespace)
  Study study;
  study.name = "conditioning";
  study.summary = "condition and quality of every stencil of a cloud";
  study.defaults.problem = "field";
  study.defaults.method = "mfpm,gfdm,lsfdm,rbf_fd";
  study.defaults.cloud = "perturbed";
  study.defaults.levels = "21,41";
  study.rated = false;
  study.mapped = true;
  study.extra_columns = {"zone"};
  study.extra_options = {{"scaling", "both",
                          "both | row: sides of the local matrix scaled by the stencil radius "
                          "before its condition is judged; by rows, quantities are called "
                          "condition_two_row_max and so on"}};
  study.check_options = [](const Options& extra) { scaling_of(extra); };
  study.quantities = quantities;
  study.run = [](const CaseKey& key, const RunOptions& options, const Options& extra) {
    return with_problem<Problem>(key.problem, "registered",
                                 [&]<int Dim>(const Problem<Dim>& problem) {
                                   return run<Dim>(problem, key, options, extra);
                                 });
  };
  return run_study(argc, argv, study);
}
