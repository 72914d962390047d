#pragma once

#include <utility>

namespace strongpoint {

/// Seconds of process CPU time when one thread runs, of wall time when several do: CPU time is not
/// disturbed by other programs on the machine.
class StageClock {
 public:
  explicit StageClock(int threads) : threads_(threads) {}

  /// Seconds since some fixed moment.
  double now() const;
  /// Runs `work`, adds the seconds it took to `seconds`, and returns what it gives.
  template <class Work>
  auto time(double& seconds, Work&& work) const {
    const Adder adder{*this, seconds, now()};
    return std::forward<Work>(work)();
  }

 private:
  struct Adder {
    const StageClock& clock;
    double& seconds;
    double begin;
    ~Adder() { seconds += clock.now() - begin; }
  };
  int threads_;
};

/// Forgets the process' peak of memory, so that the next `peak_memory_mb` speaks of what follows.
/// Where the system does not offer that (other than Linux), the peak stays that of the whole run.
void reset_peak_memory();
/// Largest resident memory since the last reset, MB (1e6 bytes).
double peak_memory_mb();

}  // namespace strongpoint
