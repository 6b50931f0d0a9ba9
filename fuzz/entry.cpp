// The entry point that libFuzzer's main program calls.

#include "fuzz/target.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  sheave::fuzz::SHEAVE_FUZZ_TARGET({data, size});
  return 0;
}
