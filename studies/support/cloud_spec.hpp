#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace strongpoint {

/// True for a cloud that is read from a file and so has a level of its own.
bool is_file_cloud(const std::string& cloud);

/// The canonical spec of a cloud, with the seed where it knows one and gives none. Throws
/// UsageError for anything that is malformed, unknown or out of range.
std::string seeded_cloud(const std::string& text, const std::optional<std::uint64_t>& seed);

/// Throws UsageError for a cloud that is read from a file but names none, which only problems with
/// a mesh of their own allow.
void check_file_is_given(const std::string& cloud, const std::string& problem);

}  // namespace strongpoint
