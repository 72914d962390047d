#include "problems/core/elastic_case.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <toml++/toml.h>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "methods/core/error.hpp"

namespace strongpoint {
namespace {

int line_of(const toml::node& node) { return static_cast<int>(node.source().begin.line); }

/// A table of a case file with its name, for messages.
struct Section {
  const ElasticCase& elastic;
  std::string name;  ///< "[material]", or empty at the top of the file
  const toml::table& table;

  [[noreturn]] void fail(const toml::node& node, const std::string& what) const {
    fail_in_case(elastic, line_of(node), what);
  }
  /// "young in [material]".
  std::string where(std::string_view key) const {
    return name.empty() ? std::string(key) : fmt::format("{} in {}", key, name);
  }
  void allow_only(const std::vector<std::string>& known) const {
    for (const auto& [key, node] : table) {
      if (std::find(known.begin(), known.end(), key.str()) != known.end()) continue;
      fail(node,
           fmt::format("unknown key {}; known: {}", where(key.str()), fmt::join(known, ", ")));
    }
  }
  /// The number that a node is.
  double number(std::string_view key, const toml::node& node) const {
    const std::optional<double> value = node.value<double>();
    if (!node.is_number() || !value) {
      fail(node, fmt::format("{} is not a number; write one such as 0.25", where(key)));
    }
    if (!std::isfinite(*value))
      fail(node, fmt::format("{} = {} is not finite", where(key), *value));
    return *value;
  }
  /// A number that has to be there.
  double required_number(std::string_view key) const {
    const toml::node* node = table.get(key);
    if (node != nullptr) return number(key, *node);
    fail(table, fmt::format("{} is missing; add it, such as {} = 0.3", where(key), key));
  }
  /// Two or three numbers.
  std::vector<double> vector(std::string_view key, const toml::node& node) const {
    const toml::array* array = node.as_array();
    if (array == nullptr || array->size() < 2 || array->size() > 3) {
      fail(node, fmt::format("{} is not a list of one number an axis; write it such as [0, -1e6]",
                             where(key)));
    }
    std::vector<double> values;
    for (const toml::node& item : *array) values.push_back(number(key, item));
    return values;
  }
  std::string text(std::string_view key, const toml::node& node) const {
    const std::optional<std::string> value = node.value<std::string>();
    if (!value || value->empty())
      fail(node, fmt::format("{} must be a text in quotes", where(key)));
    return *value;
  }
  /// The table under a key, or null.
  const toml::table* inner(std::string_view key) const {
    const toml::node* node = table.get(key);
    if (node == nullptr) return nullptr;
    if (node->as_table() == nullptr) fail(*node, fmt::format("{} is not a table", where(key)));
    return node->as_table();
  }
  /// The tables inside of the table under a key, by their lines.
  std::vector<Section> groups(std::string_view key) const {
    std::multimap<int, Section> by_line;
    const toml::table* all = inner(key);
    if (all == nullptr) return {};
    for (const auto& [group, node] : *all) {
      if (node.as_table() == nullptr) {
        fail(node,
             fmt::format("[{0}] {1} is no group; write [{0}.GROUP] above it", key, group.str()));
      }
      const std::string title = fmt::format("[{}.{}]", key, group.str());
      by_line.emplace(line_of(node), Section{elastic, title, *node.as_table()});
    }
    std::vector<Section> found;
    for (const auto& [line, section] : by_line) found.push_back(section);
    return found;
  }
  /// GROUP of "[support.GROUP]".
  std::string group() const {
    const std::size_t dot = name.find('.');
    return name.substr(dot + 1, name.size() - dot - 2);
  }
};

void read_material(const Section& section, ElasticCase& elastic) {
  section.allow_only({"young", "poisson", "state"});
  elastic.young = section.required_number("young");
  if (!(elastic.young > 0)) {
    section.fail(*section.table.get("young"),
                 fmt::format("young = {} must be positive", elastic.young));
  }
  elastic.poisson = section.required_number("poisson");
  if (!(elastic.poisson > -1 && elastic.poisson <= 0.4999)) {
    section.fail(
        *section.table.get("poisson"),
        fmt::format("poisson = {} must be more than -1 and at most 0.4999", elastic.poisson));
  }
  const toml::node* state = section.table.get("state");
  if (state == nullptr) return;
  elastic.state_line = line_of(*state);
  const std::string name = section.text("state", *state);
  if (name == "plane_stress") {
    elastic.state = PlaneState::stress;
  } else if (name != "plane_strain") {
    section.fail(*state, fmt::format("state = \"{}\" is not known; allowed: plane_strain, "
                                     "plane_stress",
                                     name));
  }
}

SupportSpec read_support(const Section& section) {
  static const std::vector<std::string> keys{"ux", "uy", "uz", "symmetry"};
  section.allow_only(keys);
  SupportSpec support{section.group(), line_of(section.table), {}};
  for (std::size_t c = 0; c < 3; ++c) {
    const toml::node* node = section.table.get(keys[c]);
    if (node != nullptr) support.displacement[c] = section.number(keys[c], *node);
  }
  const toml::node* symmetry = section.table.get("symmetry");
  if (symmetry != nullptr) {
    if (!symmetry->value<bool>().value_or(false) || section.table.size() > 1) {
      section.fail(*symmetry, fmt::format("{} can only be `symmetry = true`, alone",
                                          section.where("symmetry")));
    }
    support.is_symmetry = true;
  } else if (section.table.empty()) {
    section.fail(section.table,
                 fmt::format("{} gives nothing; add ux, uy, uz or symmetry = true", section.name));
  }
  return support;
}

LoadSpec read_load(const Section& section) {
  section.allow_only({"traction", "pressure"});
  LoadSpec load{section.group(), line_of(section.table), {}};
  if (section.table.size() != 1) {
    section.fail(section.table,
                 fmt::format("{} must give either traction or pressure", section.name));
  }
  if (const toml::node* traction = section.table.get("traction")) {
    load.traction = section.vector("traction", *traction);
  } else {
    load.pressure = section.required_number("pressure");
  }
  return load;
}

void read_probes(const Section& section, ElasticCase& elastic) {
  for (const auto& [key, node] : section.table) {
    const std::string name(key.str());
    const bool is_plain = std::all_of(name.begin(), name.end(), [](unsigned char c) {
      return std::isalnum(c) != 0 || c == '_' || c == '-';
    });
    if (!is_plain || name.empty()) {
      section.fail(
          node, fmt::format("the probe '{}' must have a name of letters, digits, _ and -", name));
    }
    elastic.probes.push_back({name, line_of(node), section.vector(name, node)});
  }
  std::sort(elastic.probes.begin(), elastic.probes.end(),
            [](const ProbeSpec& a, const ProbeSpec& b) { return a.line < b.line; });
}

void check_groups(const ElasticCase& elastic) {
  for (const LoadSpec& load : elastic.loads) {
    for (const SupportSpec& support : elastic.supports) {
      if (load.group != support.group) continue;
      fail_in_case(elastic, std::max(load.line, support.line),
                   fmt::format("group '{}' has a support (line {}) and a load (line {}); give it "
                               "one of them, or split the group",
                               load.group, support.line, load.line));
    }
  }
}

void read_tables(const Section& file, ElasticCase& elastic) {
  file.allow_only({"mesh", "material", "support", "load", "body", "probe"});
  const toml::node* mesh = file.table.get("mesh");
  if (mesh == nullptr) {
    fail_in_case(elastic, 0, "mesh is missing; begin with mesh = \"FILE.msh\"");
  }
  const std::filesystem::path folder = std::filesystem::path(elastic.path).parent_path();
  elastic.mesh = (folder / file.text("mesh", *mesh)).string();
  const toml::table* material = file.inner("material");
  if (material == nullptr) {
    fail_in_case(elastic, 0, "[material] is missing; add it with young and poisson");
  }
  read_material({elastic, "[material]", *material}, elastic);
  for (const Section& section : file.groups("support")) {
    elastic.supports.push_back(read_support(section));
  }
  for (const Section& section : file.groups("load")) elastic.loads.push_back(read_load(section));
  if (const toml::table* body = file.inner("body")) {
    const Section section{elastic, "[body]", *body};
    section.allow_only({"force"});
    const toml::node* force = body->get("force");
    if (force == nullptr) section.fail(*body, "force in [body] is missing");
    elastic.force = section.vector("force", *force);
    elastic.force_line = line_of(*force);
  }
  if (const toml::table* probe = file.inner("probe")) {
    read_probes({elastic, "[probe]", *probe}, elastic);
  }
  check_groups(elastic);
}

}  // namespace

void fail_in_case(const ElasticCase& elastic, int line, const std::string& what) {
  if (line == 0) throw CaseError(fmt::format("{}: {}", elastic.path, what));
  throw CaseError(fmt::format("{}, line {}: {}", elastic.path, line, what));
}

ElasticCase read_elastic_case(const std::string& path) {
  ElasticCase elastic;
  elastic.path = path;
  std::ifstream file(path);
  std::stringstream text;
  if (!file || !(text << file.rdbuf())) {
    fail_in_case(elastic, 0, "cannot be read, or is empty; check the path and the permissions");
  }
  toml::table table;
  try {
    table = toml::parse(text.str(), path);
  } catch (const toml::parse_error& error) {
    fail_in_case(elastic, static_cast<int>(error.source().begin.line),
                 fmt::format("is no TOML: {}", error.description()));
  }
  read_tables({elastic, "", table}, elastic);
  return elastic;
}

Lame material_of(const ElasticCase& elastic) {
  const Lame lame = lame_constants(elastic.young, elastic.poisson);
  if (elastic.state == PlaneState::strain) return lame;
  return {2 * lame.lambda * lame.mu / (lame.lambda + 2 * lame.mu), lame.mu};
}

}  // namespace strongpoint
