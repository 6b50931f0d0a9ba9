#pragma once
// Loops that are compiled twice, for pairs of doubles and for packs of four; which of the two runs
// is chosen when the program starts, by what the processor can do.
//
// Both have the same bits: products and sums are not contracted, lanes are not summed. Where
// compilers or the C library cannot do it, or the sanitizers are in the way, there are pairs alone.

#include <cstddef>  // tells __GLIBC__

#if defined(__x86_64__) && defined(__GLIBC__) && defined(__GNUC__) && !defined(__clang__) && \
    defined(__OPTIMIZE__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define SHEAVE_IN_PACKS [[gnu::target_clones("avx2", "default")]]
#else
#define SHEAVE_IN_PACKS
#endif

namespace sheave {

/// Lanes that a maximum or a minimum is taken in, so that it needs no order.
inline constexpr int pack_lanes = 8;

}  // namespace sheave
