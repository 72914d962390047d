#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "problems/core/integrator.hpp"

namespace strongpoint {

/// A file with the state of a run in time, from which a run that was killed continues to the same
/// bits. It holds the run in words, the version of the code and a checksum of everything. At no
/// time there is a torn file.
class Checkpoint {
 public:
  /// Takes the file, and a line of text that tells the run from any other. `version` is that of the
  /// code.
  Checkpoint(std::string path, const std::string& run, std::string version);

  /// What a file holds.
  enum class Found { nothing, other_version, state };

  /// Reads what was saved into a state and a memory of the same sizes, which are left alone unless
  /// it is a state. Throws CaseError for a file that is damaged or of another run.
  Found load(MotionState& state, std::span<std::byte> memory) const;
  /// Saves a state and what else must be remembered, exactly. Throws WriteError.
  void save(const MotionState& state, std::span<const std::byte> memory) const;
  /// Removes the file, if there is one.
  void remove() const;

  const std::string& path() const { return path_; }

 private:
  std::string path_, run_, version_;
};

}  // namespace strongpoint
