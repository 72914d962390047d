#pragma once

#include <array>
#include <atomic>
#include <functional>
#include <signal.h>
#include <thread>

namespace strongpoint {

/// While it lives, SIGINT and SIGTERM do not kill the process at once: a thread of its own calls
/// `finish` and then ends the process with status 130. A second signal kills as usual. A signal
/// that is being ignored stays ignored. One at a time.
class Interruption {
 public:
  explicit Interruption(std::function<void()> finish);
  Interruption(const Interruption&) = delete;
  Interruption& operator=(const Interruption&) = delete;
  ~Interruption();

 private:
  std::array<struct sigaction, 2> before_{};  ///< what the signals did until then
  std::atomic<bool> over_ = false;
  std::thread watcher_;
};

}  // namespace strongpoint
