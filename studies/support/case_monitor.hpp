#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "studies/support/save_request.hpp"

namespace strongpoint {

/// What a long case and the program that runs it tell each other meanwhile.
struct CaseMonitor {
  /// Shows how many of a case's steps are done.
  std::function<void(std::int64_t done, std::int64_t steps)> show;
  /// Tells the user something, one line.
  std::function<void(const std::string& line)> note;
  SaveRequest save;
};

}  // namespace strongpoint
