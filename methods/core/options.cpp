#include "methods/core/options.hpp"

#include <charconv>
#include <cmath>

namespace strongpoint {

Options::Options(const EntryInfo& info, const Spec& spec) : info_(info) {
  for (const OptionDoc& option : info.options) values_.push_back(option.default_value);
  for (const auto& [key, value] : spec.arguments) values_[index(key)] = value;
}

std::size_t Options::index(std::string_view key) const {
  std::string known;
  for (std::size_t i = 0; i < info_.options.size(); ++i) {
    if (info_.options[i].key == key) return i;
    known += (known.empty() ? "" : ", ") + info_.options[i].key;
  }
  throw UsageError(fmt::format("'{}' has no option '{}'; {}", info_.name, key,
                               known.empty() ? "it takes none" : "known: " + known));
}

std::string Options::where(std::string_view key) const {
  return fmt::format("{}: option {}", info_.name, key);
}

bool Options::has(std::string_view key) const { return !values_[index(key)].empty(); }

const std::string& Options::text(std::string_view key) const {
  const std::string& value = values_[index(key)];
  if (value.empty()) {
    throw UsageError(fmt::format("{} must be given: {}[{}=...]", where(key), info_.name, key));
  }
  return value;
}

double Options::number(std::string_view key, double least, double most) const {
  const std::string& value = text(key);
  double result = 0;
  const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), result);
  const bool parsed = error == std::errc() && end == value.data() + value.size();
  if (!parsed || !std::isfinite(result) || result < least || result > most) {
    throw UsageError(
        fmt::format("{}={} must be a number from {} to {}", where(key), value, least, most));
  }
  return result;
}

int Options::integer(std::string_view key, int least, int most) const {
  const std::string& value = text(key);
  int result = 0;
  const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), result);
  const bool parsed = error == std::errc() && end == value.data() + value.size();
  if (!parsed || result < least || result > most) {
    throw UsageError(
        fmt::format("{}={} must be an integer from {} to {}", where(key), value, least, most));
  }
  return result;
}

std::string Options::canonical() const {
  Spec spec{info_.name, {}};
  for (std::size_t i = 0; i < values_.size(); ++i) {
    if (values_[i] != info_.options[i].default_value) {
      spec.arguments.emplace_back(info_.options[i].key, values_[i]);
    }
  }
  return to_string(spec);
}

void Options::set(std::string_view key, std::string value) {
  values_[index(key)] = std::move(value);
}

}  // namespace strongpoint
