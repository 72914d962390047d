#pragma once

namespace strongpoint {

// GCC says by macros what the code is checked by, clang by features.
#ifndef __has_feature
#define __has_feature(name) 0  // clang's own name
#endif

/// True where every access to memory is checked: memory that is given back has to be freed.
#if defined(__SANITIZE_ADDRESS__) || __has_feature(address_sanitizer)
inline constexpr bool checks_addresses = true;
#else
inline constexpr bool checks_addresses = false;
#endif

/// True where accesses of several threads are checked.
#if defined(__SANITIZE_THREAD__) || __has_feature(thread_sanitizer)
inline constexpr bool checks_threads = true;
#else
inline constexpr bool checks_threads = false;
#endif

}  // namespace strongpoint
