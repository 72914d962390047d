#pragma once

#include <string_view>
#include <vector>

// Kernels that treat several stencils or distances at a time are written once and compiled once
// per path; which version runs is decided when the program runs. A kernel is
// - a header with a task (a plain struct of numbers and pointers) and
//   STRONGPOINT_SIMD_KERNEL(name, Task), which declares `void name(const Task&)`;
// - a source listed under strongpoint_simd_sources in methods/CMakeLists.txt, which defines the
//   function in namespace strongpoint::STRONGPOINT_SIMD_PATH (methods/core/simd/pack.hpp).
// Kernel sources include no header that holds inline functions or templates of others (Eigen,
// containers, algorithms): the linker would keep one of several copies, and it might be one that
// the processor does not know. tests/test_simd_symbols.py checks it.

namespace strongpoint {

/// The instruction sets that kernels are compiled for. Results of two paths differ by round-off.
enum class SimdPath {
  scalar,  ///< one number at a time, for any processor
  avx2,    ///< four, with fused multiply-add
  avx512   ///< eight (F, DQ, VL)
};

/// "scalar", "avx2", "avx512".
std::string_view name_of(SimdPath path);

/// Numbers that a path treats side by side: 1, 4, 8.
int lanes_of(SimdPath path);

/// The paths that this build and this processor have, the fastest last.
const std::vector<SimdPath>& simd_paths();

/// The path in use: the fastest one, unless the environment variable STRONGPOINT_SIMD names another
/// (auto, scalar, avx2, avx512). Throws UsageError for a name that is unknown or not to be had.
SimdPath simd_path();

/// Uses another path from now on; not to be called while kernels run. Throws UsageError when it is
/// not to be had.
void use_simd_path(SimdPath path);

}  // namespace strongpoint

#if defined(__x86_64__)
/// Declares the versions of a kernel, and a function that calls the one in use.
#define STRONGPOINT_SIMD_KERNEL(name, Task) \
  namespace scalar {                        \
  void name(const Task& task);              \
  }                                         \
  namespace avx2 {                          \
  void name(const Task& task);              \
  }                                         \
  namespace avx512 {                        \
  void name(const Task& task);              \
  }                                         \
  inline void name(const Task& task) {      \
    switch (simd_path()) {                  \
      case SimdPath::avx512:                \
        return avx512::name(task);          \
      case SimdPath::avx2:                  \
        return avx2::name(task);            \
      case SimdPath::scalar:                \
        return scalar::name(task);          \
    }                                       \
  }                                         \
  static_assert(true, "a semicolon follows")
#else
#define STRONGPOINT_SIMD_KERNEL(name, Task)                  \
  namespace scalar {                                         \
  void name(const Task& task);                               \
  }                                                          \
  inline void name(const Task& task) { scalar::name(task); } \
  static_assert(true, "a semicolon follows")
#endif
