#include "studies/support/command_line.hpp"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <limits>
#include <map>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "methods/core/neighbours.hpp"
#include "studies/support/provenance.hpp"

namespace strongpoint {
namespace {

/// The options as text, as far as they were given; parsing them here keeps the messages ours.
struct Given {
  std::map<std::string, std::string> values;  ///< by option, "--method"
  bool list = false, smoke = false;

  bool has(const std::string& option) const { return values.count(option) > 0; }
  std::string value(const std::string& option, const std::string& otherwise) const {
    const auto found = values.find(option);
    return found == values.end() ? otherwise : found->second;
  }
};

template <class T>
T number(const Given& given, const std::string& option, T otherwise, T least, T most) {
  if (!given.has(option)) return otherwise;
  const std::string& text = given.values.at(option);
  T result{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), result);
  if (error != std::errc() || end != text.data() + text.size() || result < least || result > most) {
    throw UsageError(
        fmt::format("{} {}: must be an integer from {} to {}", option, text, least, most));
  }
  return result;
}

std::string engine(const Given& given) {
  const std::vector<std::string>& engines = search_engines();
  std::string name = given.value("--neighbours", RunOptions{}.neighbours);
  if (std::find(engines.begin(), engines.end(), name) == engines.end()) {
    throw UsageError(fmt::format("--neighbours {}: unknown search engine; known: {}", name,
                                 fmt::join(engines, ", ")));
  }
  return name;
}

/// The first spec of a default axis, which is all that a smoke run takes.
std::string first_of(const std::string& axis) {
  return axis == "all" ? axis : split_specs(axis).front();
}

/// The stencil axis; none when each method is run with its own default.
std::optional<std::string> stencil_text(const Given& given, const Study& study,
                                        const Options& extra) {
  if (!given.has("--stencil")) {
    if (!study.default_stencils) return std::nullopt;
    const std::string axis = study.default_stencils(extra);
    return given.smoke ? first_of(axis) : axis;
  }
  for (const OptionDoc& option : study.extra_options) {
    if (!study.default_stencils || !given.has("--" + option.key)) continue;
    throw UsageError(fmt::format(
        "--{} {}: shapes the rules that are compared when --stencil is not given; write it into "
        "the specs of --stencil instead",
        option.key, given.values.at("--" + option.key)));
  }
  return given.values.at("--stencil");
}

AxisTexts axis_texts(const Given& given, const Study& study, const Options& extra) {
  const AxisDefaults& defaults = study.defaults;
  const auto axis = [&](const char* option, const std::string& otherwise) {
    return given.value(option, given.smoke ? first_of(otherwise) : otherwise);
  };
  const bool own_method = given.smoke && !defaults.smoke_method.empty();
  AxisTexts texts;
  texts.problem = axis("--problem", defaults.problem);
  texts.method = axis("--method", own_method ? defaults.smoke_method : defaults.method);
  texts.cloud = axis("--cloud", defaults.cloud);
  texts.mesh_cloud = given.value("--cloud", "file");
  texts.form = axis("--form", defaults.form);
  texts.solver = axis("--solver", defaults.solver);
  const std::string levels =
      study.default_levels && !given.smoke ? study.default_levels(extra) : defaults.levels;
  texts.levels = given.value("--levels", given.smoke ? defaults.smoke_levels : levels);
  texts.stencil = stencil_text(given, study, extra);
  return texts;
}

Options extra_options(const Given& given, const Study& study) {
  Spec spec{study.name, {}};
  for (const OptionDoc& option : study.extra_options) {
    const std::string name = "--" + option.key;
    if (given.has(name)) spec.arguments.emplace_back(option.key, given.values.at(name));
  }
  return Options({study.name, study.summary, study.extra_options}, spec);
}

/// Lets the study look at its own options; a message names those that were given.
void check_extra(const Study& study, const Given& given, const Options& extra) {
  if (!study.check_options) return;
  try {
    study.check_options(extra);
  } catch (const UsageError& error) {
    std::string options;
    for (const OptionDoc& option : study.extra_options) {
      const std::string name = "--" + option.key;
      if (!given.has(name)) continue;
      options += fmt::format("{}{} {}", options.empty() ? "" : " ", name, given.values.at(name));
    }
    throw UsageError(fmt::format("{}: {}", options, error.what()));
  }
}

/// An option of a study program with its help.
struct OptionHelp {
  std::string name, placeholder, help;  ///< a flag has no placeholder
};

std::vector<OptionHelp> option_helps(const Study& study) {
  const AxisDefaults& defaults = study.defaults;
  const std::string specs = "SPEC[,SPEC]";
  std::vector<OptionHelp> helps = {
      {"--problem", specs, "problems, or all; default " + defaults.problem},
      {"--method", specs, "methods, or all; default " + defaults.method},
      {"--stencil", specs, "stencil rules, or all; default: what suits each method"},
      {"--cloud", specs,
       "node layouts, or all; default " + defaults.cloud +
           ", or file where the problem has a mesh of its own"},
      {"--levels", "N[,N]", "nodes along the reference side; default " + defaults.levels},
      {"--form", specs, "how the system is written, or all; default " + defaults.form},
      {"--solver", specs, "linear solvers, or all; default " + defaults.solver},
      {"--threads", "N", "threads; default 1"},
      {"--repeat", "N", "runs of which timings take the minimum; default 1"},
      {"--seed", "N", "seed of clouds whose spec gives none; default 1"},
      {"--neighbours", "NAME",
       fmt::format("search engine: {}; default auto", fmt::join(search_engines(), ", "))},
      {"--vtk", "DIR",
       study.mapped ? "write the nodes with their numbers, a .vtu file a case, for ParaView"
                    : "refused: this study has no numbers per node"},
      {"--csv", "FILE", "write the tidy table; - is standard output"},
      {"--json", "FILE", "write the table with its provenance; - is standard output"},
      {"--resume", "FILE",
       study.mapped ? "keep the finished cases of this table, run the rest; --vtk writes the latter"
                    : "keep the finished cases of this table, run the rest"}};
  for (const OptionDoc& option : study.extra_options) {
    if (option.default_value == flag_off) {
      helps.push_back({"--" + option.key, "", option.doc});
      continue;
    }
    const std::string standard = option.default_value.empty() ? "none" : option.default_value;
    helps.push_back({"--" + option.key, "VALUE", option.doc + "; default " + standard});
  }
  return helps;
}

/// What CLI11 found wrong, in one line that says what is allowed.
[[noreturn]] void rethrow(const CLI::ParseError& error, const std::vector<OptionHelp>& helps) {
  std::string known;
  for (const OptionHelp& help : helps) known += help.name + ", ";
  throw UsageError(fmt::format("{}; options: {}--list, --smoke, --version, --help",
                               one_line(error.what()), known));
}

/// The arguments as text. Values are collected by hand, so that an option that swallowed the next
/// one or was given twice is told as such.
void parse(CLI::App& app, const std::vector<OptionHelp>& helps, int argc, const char* const* argv,
           Given& given) {
  for (const OptionHelp& help : helps) {
    if (help.placeholder.empty()) {
      app.add_flag_callback(
          help.name, [&given, name = help.name] { given.values[name] = flag_on; }, help.help);
      continue;
    }
    app.add_option_function<std::vector<std::string>>(
           help.name,
           [&given, name = help.name](const std::vector<std::string>& values) {
             if (values.size() != 1) {
               throw UsageError(
                   fmt::format("{} {}: given {} times; give it once, with commas between "
                               "several values",
                               name, fmt::join(values, " "), values.size()));
             }
             if (values[0].empty() || values[0].starts_with("--")) {
               throw UsageError(
                   fmt::format("{} '{}': a value is missing after the option", name, values[0]));
             }
             given.values[name] = values[0];
           },
           help.help)
        ->option_text(help.placeholder)
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  }
  app.add_flag("--list", given.list, "list what there is to choose from");
  app.add_flag("--smoke", given.smoke, "the smallest run that goes through every stage");
  app.set_version_flag("--version", code_version());
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success&) {
    throw;
  } catch (const CLI::ParseError& error) {
    rethrow(error, helps);
  }
}

/// True when both paths are given and name the same file, whether or not it exists.
bool same_file(const std::string& a, const std::string& b) {
  namespace fs = std::filesystem;
  if (a.empty() || b.empty()) return false;
  if (a == b) return true;
  if (a == "-" || b == "-") return false;
  std::error_code ignored;
  const fs::path real = fs::weakly_canonical(fs::absolute(a, ignored), ignored);
  return (!real.empty() && real == fs::weakly_canonical(fs::absolute(b, ignored), ignored)) ||
         fs::equivalent(a, b, ignored);
}

void check_files(const CommandLine& line) {
  if (line.resume == "-") {
    throw UsageError("--resume -: must be a file; standard output cannot be read back");
  }
  if (same_file(line.json, line.resume)) {
    throw UsageError(fmt::format(
        "--json {}: is the file of --resume too; give them different names", line.json));
  }
  if (same_file(line.json, line.csv)) {
    throw UsageError(
        fmt::format("--json {}: is the file of --csv too; give them different names", line.json));
  }
}

std::optional<VtkOutput> vtk_output(const Given& given, const Study& study) {
  if (!given.has("--vtk")) return std::nullopt;
  const std::string& directory = given.values.at("--vtk");
  if (!study.mapped) {
    throw UsageError(
        fmt::format("--vtk {}: {} has no numbers per node to write; leave the option out",
                    directory, study.name));
  }
  return VtkOutput{directory, study.name};
}

CommandLine plain_text(CommandLine::Action action, std::string text, const Study& study) {
  return {action, std::move(text), {}, {}, extra_options({}, study), "", true, "", ""};
}

}  // namespace

CommandLine parse_command_line(int argc, const char* const* argv, const Study& study) {
  CLI::App app(study.summary, study.name);
  Given given;
  try {
    parse(app, option_helps(study), argc, argv, given);
  } catch (const CLI::CallForHelp&) {
    return plain_text(CommandLine::Action::print, app.help(), study);
  } catch (const CLI::Success& success) {
    return plain_text(CommandLine::Action::print, std::string(success.what()) + "\n", study);
  }
  if (given.list) return plain_text(CommandLine::Action::list, "", study);
  Options extra = extra_options(given, study);
  check_extra(study, given, extra);
  CommandLine line{
      CommandLine::Action::run,
      "",
      axis_texts(given, study, extra),
      {engine(given), number(given, "--threads", 1, 1, 1024),
       number(given, "--repeat", 1, 1, 10'000),
       number<std::uint64_t>(given, "--seed", 1, 0, std::numeric_limits<std::int32_t>::max()),
       vtk_output(given, study)},
      std::move(extra),
      given.value("--csv", given.value("--resume", "")),
      !given.has("--csv"),
      given.value("--json", ""),
      given.value("--resume", "")};
  if (given.has("--seed")) line.axes.seed = line.run.seed;
  check_files(line);
  return line;
}

}  // namespace strongpoint
