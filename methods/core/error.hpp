#pragma once

#include <stdexcept>
#include <string>

namespace strongpoint {

/// A request that cannot be understood (unknown name, malformed spec): exit status 2.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A case that could not be computed (degenerate stencil, singular system): a failed row.
class CaseError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A combination that makes no sense or is not offered: a skipped row, with the reason.
class SkipCase : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace strongpoint
