#include "studies/support/frames.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include "methods/core/error.hpp"
#include "studies/support/output.hpp"

namespace strongpoint {

Frames::Frames(std::string path, int count, const Steps& steps)
    : stem_(std::filesystem::path(std::move(path)).replace_extension().string()),
      count_(count),
      steps_(steps) {
  if (count_ > steps_.count) {
    throw CaseError(fmt::format("--frames {}: the run has {} steps; take so many frames at most",
                                count_, steps_.count));
  }
}

std::int64_t Frames::step_of(int frame) const {
  return static_cast<std::int64_t>(
      std::llround(static_cast<double>(steps_.count) * frame / count_));
}

int Frames::at(std::int64_t step) const {
  const auto frame = static_cast<int>(
      std::llround(static_cast<double>(step) * count_ / static_cast<double>(steps_.count)));
  return frame >= 1 && step_of(frame) == step ? frame : 0;
}

std::string Frames::path_of(int frame) const {
  return count_ == 1 ? stem_ + ".vtu" : fmt::format("{}_{:04}.vtu", stem_, frame);
}

void Frames::write(int frame, const std::string& text) const {
  write_whole(path_of(frame), text);
  if (count_ == 1) return;
  std::string collection =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n<Collection>\n";
  for (int i = 1; i <= frame; ++i) {
    collection += fmt::format("<DataSet timestep=\"{}\" file=\"{}\"/>\n", steps_.time(step_of(i)),
                              std::filesystem::path(path_of(i)).filename().string());
  }
  write_whole(stem_ + ".pvd", collection + "</Collection>\n</VTKFile>\n");
}

}  // namespace strongpoint
