#pragma once

#include <stdexcept>
#include <string>
#include <string_view>

namespace strongpoint {

/// A file that could not be written, with the system's reason.
class WriteError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Writes one line to standard error; that it cannot be written is ignored.
void tell(const std::string& line);

/// True for `-`, devices and pipes, where what was written stays written.
bool is_stream(const std::string& path);

/// Throws UsageError, naming the option, unless `path` can be opened for writing; changes nothing.
/// `-` is standard output and always passes.
void check_writable(std::string_view option, const std::string& path);

/// Makes a directory, with those above it, unless it exists. Throws UsageError, naming the option,
/// unless files can be written there.
void make_directory(std::string_view option, const std::string& path);

/// Writes a whole file: to a temporary file beside it that is then renamed, so that at no time a
/// part of it can be seen or what was there before is lost. Devices and pipes are written in place;
/// `-` is standard output. Throws WriteError.
void write_whole(const std::string& path, std::string_view text);

/// Writes at the end of an existing file, in one system call where the system allows. `-` is
/// standard output. Throws WriteError.
void append_to(const std::string& path, std::string_view text);

}  // namespace strongpoint
