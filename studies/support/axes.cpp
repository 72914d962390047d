#include "studies/support/axes.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "methods/core/registry.hpp"
#include "problems/core/form.hpp"
#include "problems/core/layout.hpp"
#include "problems/core/problem.hpp"
#include "problems/core/solvers.hpp"
#include "studies/support/cloud_spec.hpp"
#include "studies/support/csv.hpp"

namespace strongpoint {
namespace {

/// Levels above this would not fit in memory in any dimension but one.
constexpr int largest_level = 10'000'000;

/// One spec of an axis; a status other than ok tells why cases with it are not run.
struct AxisValue {
  std::string spec;
  Status status = Status::ok;
  std::string reason{};
  int dimension = 2;        ///< of a problem
  bool has_mesh = false;    ///< of a problem: nodes of its own, which `--cloud file` takes
  std::string companion{};  ///< a method's default stencil
};

/// The specs of an axis before they are looked up. `all` may name things that need an option, which
/// is no mistake of the user's.
struct AxisText {
  std::string option;
  std::vector<std::string> specs;
  enum class Origin { written, all } origin;
};

template <class Entries, class NameOf>
AxisText axis_text(std::string option, const std::string& text, const Entries& entries,
                   NameOf&& name_of_entry) {
  if (text != "all") {
    try {
      return {option, split_specs(text), AxisText::Origin::written};
    } catch (const UsageError& error) {
      throw UsageError(fmt::format("{}: {}", option, error.what()));
    }
  }
  AxisText axis{std::move(option), {}, AxisText::Origin::all};
  for (const auto& entry : entries) axis.specs.push_back(name_of_entry(entry));
  return axis;
}

const auto registered_name = [](const auto& entry) { return entry.info.name; };
const auto listed_name = [](const EntryInfo& info) { return info.name; };

/// Looks every spec up with `make`, which fills an AxisValue from a text.
template <class Make>
std::vector<AxisValue> resolve(const AxisText& axis, Make&& make) {
  std::vector<AxisValue> values;
  for (const std::string& spec : axis.specs) {
    AxisValue value{spec};
    const auto refuse = [&](Status status, const char* reason) { value = {spec, status, reason}; };
    try {
      make(spec, value);
    } catch (const SkipCase& error) {
      refuse(Status::skipped, error.what());
    } catch (const UsageError& error) {
      if (axis.origin == AxisText::Origin::written) {
        throw UsageError(fmt::format("{} {}: {}", axis.option, spec, error.what()));
      }
      refuse(Status::skipped, error.what());
    } catch (const CaseError& error) {
      refuse(Status::failed, error.what());
    }
    values.push_back(std::move(value));
  }
  return values;
}

std::vector<AxisValue> problem_axis(const std::string& text) {
  return resolve(axis_text("--problem", text, problems(), registered_name),
                 [](const std::string& spec, AxisValue& value) {
                   const NamedProblem problem = make_problem(spec);
                   value.spec = problem.spec;
                   value.dimension = static_cast<int>(problem.made.index()) + 1;
                   value.has_mesh = std::visit(
                       [](const auto& made) { return made->domain().own_mesh().has_value(); },
                       problem.made);
                 });
}

template <int Dim>
std::vector<AxisValue> method_axis(const std::string& text) {
  return resolve(axis_text("--method", text, methods(), registered_name),
                 [](const std::string& spec, AxisValue& value) {
                   const Named<Method<Dim>> method = make_method<Dim>(spec);
                   value.spec = method.spec;
                   value.companion = method.made->default_stencil();
                 });
}

template <int Dim>
std::vector<AxisValue> stencil_axis(const AxisText& axis) {
  return resolve(axis, [](const std::string& spec, AxisValue& value) {
    value.spec = make_rule<Dim>(spec).spec;
  });
}

std::vector<int> parse_levels(const std::string& text) {
  std::set<int> levels;
  const auto reject = [&](std::string_view part) {
    throw UsageError(fmt::format(
        "--levels {}: '{}' is not allowed; give positive integers up to {}, such as 21,41,81", text,
        part, largest_level));
  };
  for (std::size_t start = 0; start <= text.size();) {
    const std::size_t end = std::min(text.find(',', start), text.size());
    std::string_view part = std::string_view(text).substr(start, end - start);
    while (part.starts_with(' ')) part.remove_prefix(1);
    while (part.ends_with(' ')) part.remove_suffix(1);
    int level = 0;
    const auto [stop, error] = std::from_chars(part.data(), part.data() + part.size(), level);
    const bool parsed = error == std::errc() && stop == part.data() + part.size();
    if (!parsed || level < 1 || level > largest_level) reject(part);
    levels.insert(level);
    start = end + 1;
  }
  return {levels.begin(), levels.end()};
}

/// The stencils a method is run with.
template <int Dim>
std::vector<AxisValue> stencils_for(const AxisValue& method,
                                    const std::optional<AxisText>& written) {
  if (method.companion == every_node) return {AxisValue{every_node}};
  if (written) return stencil_axis<Dim>(*written);
  if (method.companion.empty()) return {AxisValue{"default"}};
  return stencil_axis<Dim>(
      {"default stencil of " + method.spec, {method.companion}, AxisText::Origin::written});
}

/// A method with one of its stencils.
struct Pairing {
  AxisValue method, stencil;
};

template <int Dim>
std::vector<Pairing> pairings(const AxisTexts& texts) {
  std::optional<AxisText> written;
  if (texts.stencil) written = axis_text("--stencil", *texts.stencil, rules(), registered_name);
  std::vector<Pairing> pairs;
  for (const AxisValue& method : method_axis<Dim>(texts.method)) {
    for (const AxisValue& stencil : stencils_for<Dim>(method, written)) {
      pairs.push_back({method, stencil});
    }
  }
  return pairs;
}

std::vector<Pairing> pairings(int dimension, const AxisTexts& texts) {
  if (dimension == 1) return pairings<1>(texts);
  if (dimension == 2) return pairings<2>(texts);
  return pairings<3>(texts);
}

/// The case of a point of the grid: not to be run when one of its axes says so.
PlannedCase planned_case(const std::vector<const AxisValue*>& axes, int level) {
  PlannedCase planned;
  planned.key = {axes[0]->spec, axes[1]->spec, axes[2]->spec, axes[3]->spec,
                 axes[4]->spec, axes[5]->spec, level};
  planned.dimension = axes[0]->dimension;
  for (const AxisValue* value : axes) {
    if (value->status == Status::ok || planned.status != Status::ok) continue;
    planned.status = value->status;
    planned.reason = value->reason;
  }
  return planned;
}

/// Asks the study what the case will give.
void expect_quantities(PlannedCase& planned, const Study& study, const Options& extra) {
  try {
    if (planned.status == Status::ok) planned.quantities = study.quantities(planned.key, extra);
  } catch (const UsageError&) {
    throw;
  } catch (const SkipCase& error) {
    planned.status = Status::skipped;
    planned.reason = error.what();
  } catch (const std::exception& error) {
    planned.status = Status::failed;
    planned.reason = error.what();
  }
  if (planned.quantities.empty()) planned.quantities = {"all"};
}

/// The axes of a problem that are the same in every dimension.
struct CommonAxes {
  std::vector<AxisValue> clouds, forms, solvers;
  std::vector<int> levels;
};

CommonAxes common_axes(const AxisTexts& texts, const AxisValue& problem) {
  CommonAxes axes;
  const std::string& clouds = problem.has_mesh ? texts.mesh_cloud : texts.cloud;
  axes.clouds = resolve(axis_text("--cloud", clouds, layouts(), registered_name),
                        [&](const std::string& spec, AxisValue& value) {
                          value.spec = seeded_cloud(spec, texts.seed);
                          if (!problem.has_mesh) check_file_is_given(value.spec, problem.spec);
                        });
  axes.forms =
      resolve(axis_text("--form", texts.form, forms(), registered_name),
              [](const std::string& spec, AxisValue& value) { value.spec = canonical_form(spec); });
  axes.solvers = resolve(
      axis_text("--solver", texts.solver, solvers(), listed_name),
      [](const std::string& spec, AxisValue& value) { value.spec = canonical_solver(spec); });
  axes.levels = parse_levels(texts.levels);
  return axes;
}

/// Calls `visit(PlannedCase)` for every point of the grid of one problem, in table order.
template <class Visit>
void for_each_case(const AxisValue& problem, const std::vector<Pairing>& pairs,
                   const CommonAxes& axes, Visit&& visit) {
  const std::vector<int> own_level = {0};
  for (const Pairing& pair : pairs) {
    for (const AxisValue& cloud : axes.clouds) {
      const std::vector<int>& levels = is_file_cloud(cloud.spec) ? own_level : axes.levels;
      for (const AxisValue& form : axes.forms) {
        for (const AxisValue& solver : axes.solvers) {
          for (int level : levels) {
            visit(planned_case({&problem, &pair.method, &pair.stencil, &cloud, &form, &solver},
                               level));
          }
        }
      }
    }
  }
}

}  // namespace

std::string identity_of(const CaseKey& key) {
  return csv_line({key.problem, key.method, key.stencil, key.cloud, key.form, key.solver,
                   is_file_cloud(key.cloud) ? "" : fmt::format("{}", key.level)});
}

int level_of(std::int64_t nodes, int dimension) {
  return static_cast<int>(std::lround(std::pow(static_cast<double>(nodes), 1.0 / dimension)));
}

std::vector<PlannedCase> plan_cases(const AxisTexts& texts, const Study& study,
                                    const Options& extra) {
  const std::vector<AxisValue> problem_values = problem_axis(texts.problem);
  std::vector<PlannedCase> cases;
  std::set<std::string> seen;
  for (const AxisValue& problem : problem_values) {
    const CommonAxes axes = common_axes(texts, problem);
    for_each_case(problem, pairings(problem.dimension, texts), axes, [&](PlannedCase planned) {
      if (!seen.insert(identity_of(planned.key)).second) return;
      expect_quantities(planned, study, extra);
      cases.push_back(std::move(planned));
    });
  }
  return cases;
}

}  // namespace strongpoint
