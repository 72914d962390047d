#include "studies/support/table_file.hpp"

#include <utility>

#include <fmt/format.h>

#include "studies/support/output.hpp"

namespace strongpoint {

TableFile::TableFile(std::string program, std::string path)
    : program_(std::move(program)), path_(std::move(path)) {}

/// Writes; when that fails, sends everything so far to standard output and goes on there.
template <class Write>
void TableFile::guarded(const Write& write) {
  if (path_.empty()) return;
  try {
    write();
  } catch (const WriteError& error) {
    if (path_ == "-") throw;
    tell(fmt::format("{}: {}; the rows go to standard output", program_, error.what()));
    failed_ = true;
    path_ = "-";
    append_to(path_, written_);
  }
}

void TableFile::start(const std::string& text) {
  written_ = text;
  guarded([&] { write_whole(path_, text); });
}

void TableFile::append(const std::string& text) {
  written_ += text;
  guarded([&] { append_to(path_, text); });
}

void TableFile::finish(const std::string& whole) {
  if (whole == written_ || is_stream(path_)) return;
  written_ = whole;
  guarded([&] { write_whole(path_, whole); });
}

}  // namespace strongpoint
