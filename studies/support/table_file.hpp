#pragma once

#include <string>

namespace strongpoint {

/// The CSV table of a run, written case by case, so that a run that is killed loses no finished
/// case. When the file cannot be written any more, the rows go to standard output instead.
class TableFile {
 public:
  /// `program` is named in messages; an empty `path` makes a table that is written nowhere.
  TableFile(std::string program, std::string path);

  /// Replaces what the file holds. As all that follow, throws WriteError only when standard output
  /// cannot be written either.
  void start(const std::string& text);
  /// Adds the rows of a case.
  void append(const std::string& text);
  /// Makes the file hold `whole`; nothing happens when it does already, or when it is a stream.
  void finish(const std::string& whole);
  /// True when the file could not be written.
  bool failed() const { return failed_; }

 private:
  std::string program_, path_;
  std::string written_;
  bool failed_ = false;

  template <class Write>
  void guarded(const Write& write);
};

}  // namespace strongpoint
