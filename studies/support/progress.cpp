#include "studies/support/progress.hpp"

#include <cstdio>
#include <sys/ioctl.h>
#include <unistd.h>

#include <fmt/format.h>

namespace strongpoint {
namespace {

/// A guess at the work of a case, good enough to weigh cases against each other: its nodes in 2D.
double work_of(const CaseKey& key) {
  const double level = key.level > 0 ? key.level : 1;
  return level * level;
}

std::string clock_text(double seconds) {
  const long whole = static_cast<long>(seconds);
  if (whole < 3600) return fmt::format("{}:{:02}", whole / 60, whole % 60);
  return fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
}

std::size_t terminal_width() {
  winsize size{};
  const bool known = ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
  return known ? size.ws_col : 80;
}

}  // namespace

Progress::Progress(const std::vector<CaseKey>& pending)
    : shown_(isatty(STDERR_FILENO) == 1),
      total_(pending.size()),
      begin_(std::chrono::steady_clock::now()) {
  for (const CaseKey& key : pending) work_total_ += work_of(key);
}

Progress::~Progress() { clear(); }

void Progress::starts(const CaseKey& key) {
  case_ = key;
  show(0, "");
}

void Progress::steps(std::int64_t done, std::int64_t all) {
  const double part = static_cast<double>(done) / static_cast<double>(all);
  show(part * work_of(case_), fmt::format(" step {}/{},", done, all));
}

void Progress::show(double work_of_case, const std::string& steps) const {
  if (!shown_) return;
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begin_;
  const double done = work_done_ + work_of_case;
  const std::string left =
      done > 0 ? clock_text(elapsed.count() * (work_total_ - done) / done) : std::string("?");
  std::string line =
      fmt::format("{}/{} done,{} {} elapsed, about {} left: {} {} {} {} level {}", done_, total_,
                  steps, clock_text(elapsed.count()), left, case_.problem, case_.method,
                  case_.stencil, case_.cloud, case_.level);
  const std::size_t width = terminal_width();
  if (line.size() >= width) line.resize(width - 1);
  std::fputs(("\r" + line + "\033[K").c_str(), stderr);
  std::fflush(stderr);
}

void Progress::ends(const CaseKey& key) {
  ++done_;
  work_done_ += work_of(key);
}

void Progress::clear() {
  if (!shown_) return;
  std::fputs("\r\033[K", stderr);
  std::fflush(stderr);
}

}  // namespace strongpoint
