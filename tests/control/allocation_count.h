#pragma once

#include <cstdint>

namespace sheave::test {

/// How often this program has allocated memory so far, with operator new.
[[nodiscard]] std::int64_t allocation_count();

}  // namespace sheave::test
