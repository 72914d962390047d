#include "methods/core/large_array.hpp"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <mutex>

#ifdef __linux__
#include <sys/mman.h>
#endif

#include "methods/core/kept_memory.hpp"
#include "methods/core/sanitizers.hpp"

namespace strongpoint {
namespace {

/// Size of a huge page of most systems.
constexpr std::size_t huge_page = std::size_t{1} << 21;

/// Below this, the general allocator reuses memory more often than it hands pages back and has them
/// cleared anew.
constexpr std::size_t least_bytes = huge_page / 2;

/// What may lie idle. The arrays of a scene of 1e5 nodes fit in.
constexpr std::size_t most_kept = checks_addresses ? 0 : std::size_t{1} << 28;

void* allocate_fresh(std::size_t whole) {
  void* memory = std::aligned_alloc(huge_page, whole);
  if (memory == nullptr) throw std::bad_alloc();
#ifdef MADV_HUGEPAGE
  // Advice alone: where the system declines, ordinary pages serve.
  static_cast<void>(madvise(memory, whole, MADV_HUGEPAGE));
#endif
  return memory;
}

/// Blocks of whole huge pages. Some that were given back are kept, as the system clears each page
/// anew, at the cost of writing it: a repetition asks for the same sizes. What is used and what is
/// kept together never exceed the most that was used at once.
class BlockStore {
 public:
  void* take(std::size_t whole) {
    const std::lock_guard lock(mutex_);
    const auto kept = std::find_if(kept_.rbegin(), kept_.rend(),
                                   [whole](const Block& block) { return block.bytes == whole; });
    used_.reserve(used_.size() + 1);
    if (kept != kept_.rend()) {
      used_.push_back(*kept);
      kept_bytes_ -= whole;
      kept_.erase(std::next(kept).base());
    } else {
      most_used_ = std::max(most_used_, used_bytes_ + whole);
      shrink_to(most_used_ - used_bytes_ - whole);
      used_.push_back({allocate_fresh(whole), whole});
    }
    used_bytes_ += whole;
    return used_.back().memory;
  }

  /// False when the memory is none of its blocks.
  bool give_back(void* memory) noexcept {
    const std::lock_guard lock(mutex_);
    const auto place = std::find_if(used_.begin(), used_.end(), [memory](const Block& block) {
      return block.memory == memory;
    });
    if (place == used_.end()) return false;
    const Block block = *place;
    used_.erase(place);
    used_bytes_ -= block.bytes;
    if (block.bytes > most_kept || kept_.size() == kept_.capacity()) {
      std::free(block.memory);
      return true;
    }
    shrink_to(most_kept - block.bytes);
    kept_.push_back(block);
    kept_bytes_ += block.bytes;
    return true;
  }

  void release() {
    const std::lock_guard lock(mutex_);
    shrink_to(0);
    most_used_ = used_bytes_;
  }

  BlockStore() { kept_.reserve(most_kept / huge_page); }

 private:
  struct Block {
    void* memory;
    std::size_t bytes;
  };

  std::mutex mutex_;
  std::vector<Block> used_, kept_;  ///< the oldest first
  std::size_t used_bytes_ = 0;
  std::size_t kept_bytes_ = 0;
  std::size_t most_used_ = 0;

  /// Frees what was kept longest until so many bytes are left.
  void shrink_to(std::size_t bytes) noexcept {
    auto end = kept_.begin();
    for (; kept_bytes_ > bytes; ++end) {
      std::free(end->memory);
      kept_bytes_ -= end->bytes;
    }
    kept_.erase(kept_.begin(), end);
  }
};

/// Never destroyed: arrays with static storage are freed later.
BlockStore& block_store() {
  static auto* const store = new BlockStore;
  return *store;
}

}  // namespace

void* allocate_large(std::size_t bytes) {
  if (bytes < least_bytes) {
    void* memory = std::malloc(bytes > 0 ? bytes : 1);
    if (memory == nullptr) throw std::bad_alloc();
    return memory;
  }
  return block_store().take((bytes + huge_page - 1) / huge_page * huge_page);
}

void free_large(void* memory) noexcept {
  const bool may_be_block = reinterpret_cast<std::uintptr_t>(memory) % huge_page == 0;
  if (memory != nullptr && may_be_block && block_store().give_back(memory)) return;
  std::free(memory);
}

void release_kept_memory() { block_store().release(); }

}  // namespace strongpoint
