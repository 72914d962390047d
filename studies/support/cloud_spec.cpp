#include "studies/support/cloud_spec.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "methods/core/error.hpp"
#include "problems/core/layout.hpp"

namespace strongpoint {
namespace {

/// Throws UsageError for an option value that only making a cloud would look at, so that it is told
/// before anything runs.
void check_values(const std::string& canonical) {
  if (is_file_cloud(canonical)) return;
  constexpr int trial_level = 5;
  try {
    static_cast<void>(make_cloud<2>(UnitCube<2>(), canonical, {trial_level, 1}));
  } catch (const SkipCase&) {
    // What the unit square cannot serve may suit the problem's domain.
  } catch (const CaseError&) {
  }
}

}  // namespace

bool is_file_cloud(const std::string& cloud) {
  return find_entry(layouts(), "cloud", parse_spec(cloud).name).sizing == Sizing::by_file;
}

std::string seeded_cloud(const std::string& text, const std::optional<std::uint64_t>& seed) {
  Spec spec = parse_spec(text);
  const EntryInfo& info = find_entry(layouts(), "cloud", spec.name).info;
  const bool knows = std::any_of(info.options.begin(), info.options.end(),
                                 [](const OptionDoc& option) { return option.key == "seed"; });
  const bool gives = std::any_of(spec.arguments.begin(), spec.arguments.end(),
                                 [](const auto& argument) { return argument.first == "seed"; });
  if (seed && knows && !gives) spec.arguments.emplace_back("seed", fmt::format("{}", *seed));
  std::string canonical = canonical_cloud(to_string(spec));
  check_values(canonical);
  return canonical;
}

void check_file_is_given(const std::string& cloud, const std::string& problem) {
  const Spec spec = parse_spec(cloud);
  const LayoutEntry& entry = find_entry(layouts(), "cloud", spec.name);
  if (entry.sizing != Sizing::by_file || Options(entry.info, spec).has("path")) return;
  throw UsageError(
      fmt::format("{0}: path= is missing, and {1} has no mesh of its own; give a file, "
                  "as in {0}[path=nodes.csv]",
                  spec.name, problem));
}

}  // namespace strongpoint
