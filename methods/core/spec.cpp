#include "methods/core/spec.hpp"

#include <algorithm>
#include <cctype>

#include <fmt/format.h>

#include "methods/core/error.hpp"

namespace strongpoint {
namespace {

std::string_view trimmed(std::string_view text) {
  const std::string_view blanks = " \t\n";
  const std::size_t first = text.find_first_not_of(blanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

[[noreturn]] void malformed(std::string_view text, std::string_view why) {
  throw UsageError(
      fmt::format("malformed spec '{}': {}; write name or name[key=value,...]", text, why));
}

bool is_name(std::string_view text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '_';
  });
}

/// Throws unless every bracket in `text` closes.
void check_brackets(std::string_view text) {
  int depth = 0;
  for (char c : text) {
    depth += (c == '[') - (c == ']');
    if (depth < 0) malformed(text, "a ']' without its '['");
  }
  if (depth > 0) malformed(text, "a '[' is never closed");
}

}  // namespace

std::vector<std::string> split_specs(std::string_view text) {
  check_brackets(text);
  std::vector<std::string> parts;
  int depth = 0;
  std::size_t start = 0;
  for (std::size_t i = 0; i <= text.size(); ++i) {
    if (i < text.size()) depth += (text[i] == '[') - (text[i] == ']');
    if (i == text.size() || (text[i] == ',' && depth == 0)) {
      parts.emplace_back(trimmed(text.substr(start, i - start)));
      start = i + 1;
    }
  }
  return parts;
}

Spec parse_spec(std::string_view text) {
  text = trimmed(text);
  check_brackets(text);
  const std::size_t open = text.find('[');
  Spec spec{std::string(trimmed(text.substr(0, open))), {}};
  if (!is_name(spec.name)) malformed(text, "a name of letters, digits and '_' must come first");
  if (open == std::string_view::npos) return spec;
  if (text.back() != ']') malformed(text, "nothing may follow the closing ']'");
  const std::string_view inside = trimmed(text.substr(open + 1, text.size() - open - 2));
  if (inside.empty()) return spec;
  for (const std::string& part : split_specs(inside)) {
    const std::size_t equals = part.find('=');
    if (equals == std::string::npos) malformed(text, fmt::format("'{}' is not key=value", part));
    std::string key(trimmed(std::string_view(part).substr(0, equals)));
    std::string value(trimmed(std::string_view(part).substr(equals + 1)));
    if (!is_name(key)) malformed(text, fmt::format("'{}' is not a key", key));
    if (value.empty()) malformed(text, fmt::format("key '{}' has no value", key));
    const bool repeated = std::any_of(spec.arguments.begin(), spec.arguments.end(),
                                      [&](const auto& argument) { return argument.first == key; });
    if (repeated) malformed(text, fmt::format("key '{}' is given twice", key));
    spec.arguments.emplace_back(std::move(key), std::move(value));
  }
  return spec;
}

std::string to_string(const Spec& spec) {
  if (spec.arguments.empty()) return spec.name;
  std::string text = spec.name + "[";
  for (std::size_t i = 0; i < spec.arguments.size(); ++i) {
    text += fmt::format("{}{}={}", i == 0 ? "" : ",", spec.arguments[i].first,
                        spec.arguments[i].second);
  }
  return text + "]";
}

}  // namespace strongpoint
