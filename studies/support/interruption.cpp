#include "studies/support/interruption.hpp"

#include <cerrno>
#include <cstdio>
#include <semaphore.h>
#include <unistd.h>
#include <utility>

namespace strongpoint {
namespace {

/// What shells report for a program that ^C ended.
constexpr int interrupted_status = 130;

constexpr std::array<int, 2> watched = {SIGINT, SIGTERM};

/// Wakes the watcher. Global, as a signal handler is given nothing else, and a semaphore, as little
/// else may be touched in one. (Blocking the signals and waiting for them would be simpler, but
/// numerical libraries start threads before main that do not block them.)
sem_t wake;

extern "C" void strongpoint_wake(int) { sem_post(&wake); }

}  // namespace

Interruption::Interruption(std::function<void()> finish) {
  sem_init(&wake, 0, 0);
  watcher_ = std::thread([this, finish = std::move(finish)] {
    while (sem_wait(&wake) != 0 && errno == EINTR) {
    }
    if (over_) return;
    finish();
    std::fflush(nullptr);
    _exit(interrupted_status);
  });
  struct sigaction action {};
  action.sa_handler = strongpoint_wake;
  action.sa_flags = static_cast<int>(SA_RESTART | SA_RESETHAND);
  for (std::size_t i = 0; i < watched.size(); ++i) {
    sigaction(watched[i], nullptr, &before_[i]);
    if (before_[i].sa_handler != SIG_IGN) sigaction(watched[i], &action, nullptr);
  }
}

Interruption::~Interruption() {
  for (std::size_t i = 0; i < watched.size(); ++i) sigaction(watched[i], &before_[i], nullptr);
  over_ = true;
  sem_post(&wake);
  watcher_.join();
  sem_destroy(&wake);
}

}  // namespace strongpoint
