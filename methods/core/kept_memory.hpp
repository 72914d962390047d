#pragma once

namespace strongpoint {

/// Hands back to the system what `free_large` kept: blocks of two megabytes or more, up to 256 MB
/// in all and never more than the most that was in use together. A repetition takes them again, as
/// the system clears each page that it hands out.
void release_kept_memory();

}  // namespace strongpoint
