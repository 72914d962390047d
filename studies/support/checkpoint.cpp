#include "studies/support/checkpoint.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "methods/core/error.hpp"
#include "studies/support/output.hpp"
#include "studies/support/row.hpp"

namespace strongpoint {
namespace {

constexpr std::string_view magic = "strongpoint checkpoint 1";

/// Hash of a text. Source: Fowler, Noll and Vo, FNV-1a with 64 bits.
std::uint64_t hash_of(std::string_view text) {
  std::uint64_t hash = 14695981039346656037U;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211U;
  return hash;
}

/// Step, and the sizes of what follows: numbers of the three vectors, bytes of the memory.
using Sizes = std::array<std::int64_t, 5>;

Sizes sizes_of(const MotionState& state, std::size_t memory) {
  return {state.step, state.displacement.size(), state.velocity.size(), state.acceleration.size(),
          static_cast<std::int64_t>(memory)};
}

void append(std::string& text, const void* bytes, std::size_t count) {
  text.append(static_cast<const char*>(bytes), count);
}

void append(std::string& text, const Eigen::VectorXd& numbers) {
  append(text, numbers.data(), static_cast<std::size_t>(numbers.size()) * sizeof(double));
}

std::string payload_of(const MotionState& state, std::span<const std::byte> memory) {
  std::string text;
  const Sizes sizes = sizes_of(state, memory.size());
  append(text, sizes.data(), sizeof sizes);
  append(text, state.displacement);
  append(text, state.velocity);
  append(text, state.acceleration);
  append(text, memory.data(), memory.size());
  return text;
}

/// Takes bytes off the front of a text that is long enough.
void take(std::string_view& text, void* bytes, std::size_t count) {
  if (count > 0) std::memcpy(bytes, text.data(), count);  // nothing has no address
  text.remove_prefix(count);
}

void take(std::string_view& text, Eigen::VectorXd& numbers) {
  take(text, numbers.data(), static_cast<std::size_t>(numbers.size()) * sizeof(double));
}

/// Takes a line off the front of a text; all of it when it has no end of line.
std::string_view take_line(std::string_view& text) {
  const std::size_t end = std::min(text.find('\n'), text.size());
  const std::string_view line = text.substr(0, end);
  text.remove_prefix(std::min(end + 1, text.size()));
  return line;
}

std::string checksum_of(std::string_view version, std::string_view run, std::string_view payload) {
  return fmt::format("{:016x}", hash_of(fmt::format("{}\n{}\n{}", version, run, payload)));
}

}  // namespace

Checkpoint::Checkpoint(std::string path, const std::string& run, std::string version)
    : path_(std::move(path)), run_(one_line(run)), version_(std::move(version)) {}

Checkpoint::Found Checkpoint::load(MotionState& state, std::span<std::byte> memory) const {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path_, ignored)) return Found::nothing;
  const auto refuse = [this](std::string_view why) {
    throw CaseError(fmt::format(
        "checkpoint {} {}; delete it to start anew, or name another --checkpoint directory", path_,
        why));
  };
  std::ifstream file(path_, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  if (!file) refuse("cannot be read");
  std::string_view rest = text;
  if (take_line(rest) != magic) refuse("is damaged: it does not begin as a checkpoint does");
  const std::string_view version = take_line(rest);
  const std::string_view run = take_line(rest);
  const std::string_view checksum = take_line(rest);
  if (checksum != checksum_of(version, run, rest)) {
    refuse("is damaged: it ends early, or some of its bytes have changed");
  }
  if (version != version_) return Found::other_version;
  if (run != run_) refuse(fmt::format("is of another run: {}", run));
  Sizes sizes{};
  const Sizes expected = sizes_of(state, memory.size());
  if (rest.size() >= sizeof sizes) take(rest, sizes.data(), sizeof sizes);
  const auto bytes =
      static_cast<std::size_t>(expected[1] + expected[2] + expected[3]) * sizeof(double) +
      memory.size();
  if (!std::equal(sizes.begin() + 1, sizes.end(), expected.begin() + 1) || rest.size() != bytes) {
    refuse("holds another number of unknowns than the case has");
  }
  state.step = sizes[0];
  take(rest, state.displacement);
  take(rest, state.velocity);
  take(rest, state.acceleration);
  take(rest, memory.data(), memory.size());
  return Found::state;
}

void Checkpoint::save(const MotionState& state, std::span<const std::byte> memory) const {
  const std::string payload = payload_of(state, memory);
  write_whole(path_, fmt::format("{}\n{}\n{}\n{}\n{}", magic, version_, run_,
                                 checksum_of(version_, run_, payload), payload));
}

void Checkpoint::remove() const {
  std::error_code ignored;
  std::filesystem::remove(path_, ignored);
  std::filesystem::remove(path_ + ".part", ignored);  // of a run killed while it saved
}

}  // namespace strongpoint
