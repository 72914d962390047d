#pragma once

#include <cstdint>
#include <string>

#include "studies/support/march.hpp"

namespace strongpoint {

/// The instants of a run in time that are written for ParaView: `count` of them, equally spaced up
/// to the end, each at the nearest step. A single one is the file of the case; several are numbered
/// and stand with their times in a collection (.pvd), which ParaView plays.
class Frames {
 public:
  /// Takes the file of the case, ending in .vtu, how many instants are wanted and the steps. Throws
  /// CaseError when there are fewer steps.
  Frames(std::string path, int count, const Steps& steps);

  /// The number of the instant at a step, from 1; 0 when the step is none.
  int at(std::int64_t step) const;
  /// Writes the text of an instant's file, and the collection up to it. Throws WriteError.
  void write(int frame, const std::string& text) const;

 private:
  std::string stem_;  ///< of the paths
  int count_;
  Steps steps_;

  std::int64_t step_of(int frame) const;
  std::string path_of(int frame) const;
};

}  // namespace strongpoint
