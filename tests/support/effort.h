#pragma once
// How long the long tests run.

namespace sheave::test {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool instrumented = true;
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
inline constexpr bool instrumented = true;
#else
inline constexpr bool instrumented = false;
#endif
#else
inline constexpr bool instrumented = false;
#endif

// Of the libraries, in which tests spend their time. Tests themselves are not optimised in any build.
#ifdef NDEBUG
inline constexpr bool optimised = true;
#else
inline constexpr bool optimised = false;
#endif

/// A number of steps that is 1/50 of itself in slow builds (sanitizers, no optimisation).
[[nodiscard]] constexpr int long_run(int steps) {
  return instrumented || !optimised ? (steps + 49) / 50 : steps;
}

}  // namespace sheave::test
