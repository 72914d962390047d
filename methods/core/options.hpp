#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "methods/core/error.hpp"
#include "methods/core/spec.hpp"

namespace strongpoint {

/// One option of a registered thing: its key, its default as a user would write it, what it means.
struct OptionDoc {
  std::string key;
  std::string default_value;  ///< empty: no default, the option may be left out
  std::string doc;
};

/// Name, one-line description and options of anything that a spec can choose.
struct EntryInfo {
  std::string name;
  std::string summary;
  std::vector<OptionDoc> options;
};

/// The options of one spec with the defaults filled in. Every getter throws UsageError, naming the
/// option, the value and what is allowed, when the value does not fit.
class Options {
 public:
  /// Matches a spec against the documented options; an unknown key throws, listing the known ones.
  Options(const EntryInfo& info, const Spec& spec);

  /// True when the option has a value, from the spec or by default.
  bool has(std::string_view key) const;
  /// The text of an option that has a value.
  const std::string& text(std::string_view key) const;
  /// A finite number within [least, most].
  double number(std::string_view key, double least, double most) const;
  /// An integer within [least, most].
  int integer(std::string_view key, int least, int most) const;
  /// One of the named choices.
  template <class T>
  T choice(std::string_view key, const std::vector<std::pair<std::string, T>>& choices) const;
  /// The spec with only the options that differ from their defaults, in documented order; it can be
  /// pasted back.
  std::string canonical() const;
  /// Replaces the value of a nested spec by its canonical form.
  void set(std::string_view key, std::string value);
  /// "name: key" for messages.
  std::string where(std::string_view key) const;

 private:
  EntryInfo info_;
  std::vector<std::string> values_;  ///< one per documented option

  std::size_t index(std::string_view key) const;
};

/// Finds the entry called `name`, or throws UsageError that lists the known names. `Entry` has
/// `info`.
template <class Entry>
const Entry& find_entry(const std::vector<Entry>& entries, std::string_view kind,
                        std::string_view name) {
  std::string known;
  for (const Entry& entry : entries) {
    if (entry.info.name == name) return entry;
    known += (known.empty() ? "" : ", ") + entry.info.name;
  }
  throw UsageError(fmt::format("unknown {} '{}'; known: {}", kind, name, known));
}

template <class T>
T Options::choice(std::string_view key,
                  const std::vector<std::pair<std::string, T>>& choices) const {
  std::string known;
  for (const auto& [name, value] : choices) {
    if (name == text(key)) return value;
    known += (known.empty() ? "" : ", ") + name;
  }
  throw UsageError(fmt::format("{}={} is not known; allowed: {}", where(key), text(key), known));
}

}  // namespace strongpoint
