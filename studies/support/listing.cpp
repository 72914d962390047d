#include "studies/support/listing.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "methods/core/registry.hpp"
#include "problems/core/damping.hpp"
#include "problems/core/form.hpp"
#include "problems/core/integrator.hpp"
#include "problems/core/layout.hpp"
#include "problems/core/problem.hpp"
#include "problems/core/solvers.hpp"

namespace strongpoint {
namespace {

std::string described(const EntryInfo& info) {
  std::string text = fmt::format("  {:<15} {}\n", info.name, info.summary);
  std::vector<std::string> keys;
  std::size_t width = 0;
  for (const OptionDoc& option : info.options) {
    keys.push_back(option.default_value.empty() ? option.key + "=..."
                                                : option.key + "=" + option.default_value);
    width = std::max(width, keys.back().size());
  }
  for (std::size_t i = 0; i < keys.size(); ++i) {
    text += fmt::format("  {:<15}   {:<{}}  {}\n", "", keys[i], width, info.options[i].doc);
  }
  return text;
}

const EntryInfo& info_of(const EntryInfo& info) { return info; }
template <class Entry>
const EntryInfo& info_of(const Entry& entry) {
  return entry.info;
}

template <class Entries>
std::string section(const char* title, const Entries& entries) {
  std::string text = fmt::format("{}\n", title);
  for (const auto& entry : entries) text += described(info_of(entry));
  return text + '\n';
}

bool runs_in_time(const Study& study) {
  return std::any_of(study.extra_options.begin(), study.extra_options.end(),
                     [](const OptionDoc& option) { return option.key == "time"; });
}

}  // namespace

std::string listing(const Study& study) {
  std::string text =
      fmt::format("{}: {}\n\nWrite name or name[key=value,...]; key=... has no default.\n\n",
                  study.name, study.summary);
  text += section("problems (--problem)", problems());
  text += section("methods (--method)", methods());
  text += section("stencil rules (--stencil)", rules());
  text += section("clouds (--cloud)", layouts());
  text += section("forms (--form)", forms());
  text += section("solvers (--solver)", solvers());
  if (runs_in_time(study)) {
    text += section("steps in time (--time)", integrators());
    text += section("damping in time (--damping)", dampings());
  }
  text += section("weights (weight= of the methods that take one)", weight_functions());
  return text +
         fmt::format("search engines (--neighbours)\n  {}\n", fmt::join(search_engines(), ", "));
}

}  // namespace strongpoint
