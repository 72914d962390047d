#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>

namespace strongpoint {

/// Lets one thread ask the run in another one to save its state, and wait until it has.
class SaveRequest {
 public:
  /// While it lives, somebody serves requests.
  class Server {
   public:
    /// Serves `request`, which must outlive it; null: nothing happens.
    explicit Server(SaveRequest* request);
    Server(const Server&) = delete;
    Server& operator=(const Server&) = delete;
    ~Server();

    /// True when somebody waits for a state to be saved.
    bool is_asked() const { return request_ != nullptr && request_->asked_.load(); }
    /// Tells that it was saved.
    void done();

   private:
    SaveRequest* request_;
  };

  /// Waits until the request is served, or the server gone, but no longer than `patience`. Nothing
  /// happens without a server.
  void ask(std::chrono::milliseconds patience);

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  bool has_server_ = false;
  std::atomic<bool> asked_ = false;
};

}  // namespace strongpoint
