#include "methods/core/simd/path.hpp"

#include <algorithm>
#include <cstdlib>
#include <string>

#include <fmt/format.h>

#include "methods/core/error.hpp"

namespace strongpoint {
namespace {

std::vector<SimdPath> paths_here() {
  std::vector<SimdPath> paths{SimdPath::scalar};
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) {
    paths.push_back(SimdPath::avx2);
  }
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
      __builtin_cpu_supports("avx512vl")) {
    paths.push_back(SimdPath::avx512);
  }
#endif
  return paths;
}

/// The path that the environment asks for.
SimdPath path_asked_for() {
  const char* const asked = std::getenv("STRONGPOINT_SIMD");
  const std::string_view name = asked == nullptr ? "auto" : asked;
  if (name.empty() || name == "auto") return simd_paths().back();
  std::string known = "auto";
  for (SimdPath path : simd_paths()) {
    if (name_of(path) == name) return path;
    known += fmt::format(", {}", name_of(path));
  }
  throw UsageError(
      fmt::format("STRONGPOINT_SIMD={}: no such path on this processor; allowed: {}", name, known));
}

SimdPath& path_in_use() {
  static SimdPath path = path_asked_for();
  return path;
}

}  // namespace

std::string_view name_of(SimdPath path) {
  switch (path) {
    case SimdPath::avx512:
      return "avx512";
    case SimdPath::avx2:
      return "avx2";
    case SimdPath::scalar:
      break;
  }
  return "scalar";
}

int lanes_of(SimdPath path) {
  switch (path) {
    case SimdPath::avx512:
      return 8;
    case SimdPath::avx2:
      return 4;
    case SimdPath::scalar:
      break;
  }
  return 1;
}

const std::vector<SimdPath>& simd_paths() {
  static const std::vector<SimdPath> paths = paths_here();
  return paths;
}

SimdPath simd_path() { return path_in_use(); }

void use_simd_path(SimdPath path) {
  if (std::find(simd_paths().begin(), simd_paths().end(), path) == simd_paths().end()) {
    throw UsageError(
        fmt::format("the SIMD path {} is not to be had on this processor", name_of(path)));
  }
  path_in_use() = path;
}

}  // namespace strongpoint
