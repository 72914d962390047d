#include "studies/support/output.hpp"

#include <cerrno>
#include <cstdio>
#include <fcntl.h>
#include <filesystem>
#include <system_error>
#include <unistd.h>

#include <fmt/format.h>

#include "methods/core/error.hpp"

namespace strongpoint {
namespace {

namespace fs = std::filesystem;

constexpr mode_t new_file_mode = 0666;

std::string reason(int error) { return std::generic_category().message(error); }

[[noreturn]] void fail(const std::string& path, int error) {
  throw WriteError(fmt::format("cannot write {}: {}",
                               path == "-" ? "standard output" : "'" + path + "'", reason(error)));
}

int opened(const std::string& path, int flags) {
  const int id =
      path == "-" ? ::dup(STDOUT_FILENO) : ::open(path.c_str(), flags | O_CLOEXEC, new_file_mode);
  if (id < 0) fail(path, errno);
  return id;
}

/// An open file descriptor.
class Descriptor {
 public:
  Descriptor(const std::string& path, int flags) : path_(path), id_(opened(path, flags)) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() {
    if (id_ >= 0) ::close(id_);
  }

  void write(std::string_view text) {
    while (!text.empty()) {
      const ssize_t written = ::write(id_, text.data(), text.size());
      if (written < 0 && errno == EINTR) continue;
      if (written < 0) fail(path_, errno);
      text.remove_prefix(static_cast<std::size_t>(written));
    }
  }
  /// Closes; some file systems report a full disk only now.
  void close() {
    const int id = id_;
    id_ = -1;
    if (::close(id) != 0 && errno != EINTR) fail(path_, errno);
  }

 private:
  std::string path_;
  int id_;
};

/// The file a path names once links are followed; renaming would otherwise replace the link.
fs::path real_path(const std::string& path) {
  std::error_code ignored;
  const fs::path real = fs::canonical(path, ignored);
  return real.empty() ? fs::path(path) : real;
}

}  // namespace

void tell(const std::string& line) { std::fputs((line + '\n').c_str(), stderr); }

bool is_stream(const std::string& path) {
  std::error_code ignored;
  const fs::file_status status = fs::status(path, ignored);
  return path == "-" || (fs::exists(status) && !fs::is_regular_file(status));
}

void check_writable(std::string_view option, const std::string& path) {
  if (path == "-") return;
  std::error_code ignored;
  const bool existed = fs::exists(path, ignored);
  const int id =
      ::open(path.c_str(), O_WRONLY | O_APPEND | O_CREAT | O_CLOEXEC | O_NONBLOCK, new_file_mode);
  const int error = errno;
  // A pipe that nobody reads yet cannot be opened without waiting, which is no fault.
  if (id < 0 && error == ENXIO) return;
  if (id < 0) {
    throw UsageError(
        fmt::format("{} {}: cannot be opened for writing ({}); name a file in a "
                    "directory that exists and can be written",
                    option, path, reason(error)));
  }
  ::close(id);
  if (!existed) fs::remove(path, ignored);
  const fs::path directory = fs::absolute(real_path(path)).parent_path();
  if (!is_stream(path) && ::access(directory.c_str(), W_OK) != 0) {
    throw UsageError(
        fmt::format("{} {}: its directory cannot be written ({}), which a safe "
                    "replacement takes; name a file elsewhere",
                    option, path, reason(errno)));
  }
}

void make_directory(std::string_view option, const std::string& path) {
  std::error_code error;
  fs::create_directories(path, error);
  if (!error && !fs::is_directory(path)) error = std::make_error_code(std::errc::not_a_directory);
  if (!error && ::access(path.c_str(), W_OK) != 0) error = {errno, std::generic_category()};
  if (!error) return;
  throw UsageError(fmt::format("{} {}: is no directory that can be written ({}); name one that can",
                               option, path, error.message()));
}

void write_whole(const std::string& path, std::string_view text) {
  if (is_stream(path)) {
    append_to(path, text);
    return;
  }
  const fs::path target = real_path(path);
  const std::string temporary = target.string() + ".part";
  std::error_code error;
  try {
    Descriptor file(temporary, O_WRONLY | O_CREAT | O_TRUNC);
    file.write(text);
    file.close();
  } catch (const WriteError&) {
    fs::remove(temporary, error);
    throw;
  }
  if (fs::exists(target, error)) {
    fs::permissions(temporary, fs::status(target, error).permissions(), error);
  }
  fs::rename(temporary, target, error);
  if (error) fail(path, error.value());
}

void append_to(const std::string& path, std::string_view text) {
  Descriptor file(path, O_WRONLY | O_APPEND);
  file.write(text);
  file.close();
}

}  // namespace strongpoint
