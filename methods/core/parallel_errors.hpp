#pragma once

#include <cstdint>
#include <exception>
#include <limits>
#include <utility>

namespace strongpoint {

/// Carries an exception out of a parallel loop, which must not be left by one: the error of the
/// lowest index is kept and thrown again behind the loop, whatever the number of threads.
class ParallelErrors {
 public:
  /// Runs the work of one iteration; what it throws is kept.
  template <class Work>
  void guard(std::int64_t index, Work&& work) noexcept {
    try {
      std::forward<Work>(work)();
    } catch (...) {
#pragma omp critical(strongpoint_parallel_errors)
      if (index < lowest_) {
        lowest_ = index;
        error_ = std::current_exception();
      }
    }
  }
  /// Throws the kept error, if there is one.
  void rethrow() const {
    if (error_) std::rethrow_exception(error_);
  }

 private:
  std::int64_t lowest_ = std::numeric_limits<std::int64_t>::max();
  std::exception_ptr error_;
};

}  // namespace strongpoint
