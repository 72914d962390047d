#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace strongpoint {

/// What a user writes to choose something: `name[key=value,...]`, where a value may itself be a
/// spec.
struct Spec {
  std::string name;
  std::vector<std::pair<std::string, std::string>> arguments;  ///< in the order written

  bool operator==(const Spec&) const = default;
};

/// Parses one spec. Throws UsageError that shows the text and the place when it is malformed.
Spec parse_spec(std::string_view text);

/// Splits a list of specs at the commas outside brackets; blanks around a spec are dropped.
std::vector<std::string> split_specs(std::string_view text);

/// Writes a spec so that `parse_spec` gives it back.
std::string to_string(const Spec& spec);

}  // namespace strongpoint
