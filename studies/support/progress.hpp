#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

#include "studies/support/study.hpp"

namespace strongpoint {

/// One line on standard error that tells how far a run has come; silent unless that is a terminal.
class Progress {
 public:
  /// `pending` are the cases that will be run, in order.
  explicit Progress(const std::vector<CaseKey>& pending);
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  ~Progress();

  /// Tells that a case starts.
  void starts(const CaseKey& key);
  /// Tells how far the case is, in steps of about the same length.
  void steps(std::int64_t done, std::int64_t all);
  /// Tells that the case ended.
  void ends(const CaseKey& key);
  /// Wipes the line, so that something else can be printed.
  void clear();

 private:
  bool shown_;  ///< standard error is a terminal
  std::size_t total_, done_ = 0;
  double work_total_ = 0, work_done_ = 0;
  std::chrono::steady_clock::time_point begin_;
  CaseKey case_;

  void show(double work_of_case, const std::string& steps) const;
};

}  // namespace strongpoint
