#pragma once
// Loops that are compiled twice, for pairs of doubles and for packs of four. The program chooses
// one of the two when it starts, according to the processor.
//
// Both give the same bits: products and sums are not contracted, and lanes are not summed. Where
// the compiler or the C library does not support the choice, or sanitizers prevent it, only pairs
// exist.

#include <cstddef>  // tells __GLIBC__

#if defined(__x86_64__) && defined(__GLIBC__) && defined(__GNUC__) && !defined(__clang__) && \
    defined(__OPTIMIZE__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define SHEAVE_IN_PACKS [[gnu::target_clones("avx2", "default")]]
#else
#define SHEAVE_IN_PACKS
#endif

namespace sheave {

/// Lanes of a maximum or minimum, which does not depend on the order of its arguments.
inline constexpr int pack_lanes = 8;

}  // namespace sheave
