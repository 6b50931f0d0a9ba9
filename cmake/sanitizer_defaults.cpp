// Linked into every sanitized executable, so that it behaves the same whether ctest, a script or a
// person starts it. The environment variables of the same names still override these.

extern "C" const char* __asan_default_options();
extern "C" const char* __asan_default_options() {
  return "detect_leaks=1:strict_init_order=1:check_initialization_order=1:detect_stack_use_after_"
         "return=1";
}

extern "C" const char* __ubsan_default_options();
extern "C" const char* __ubsan_default_options() { return "print_stacktrace=1"; }

// The software rasteriser keeps some of its tables until the process ends.
extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() {
  return "leak:libOSMesa\nleak:libLLVM\nleak:libglapi\nleak:libgallium\n";
}

extern "C" const char* __lsan_default_options();
extern "C" const char* __lsan_default_options() { return "print_suppressions=0"; }
