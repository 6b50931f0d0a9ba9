// The `sheave` command, and how it ends.

#include <cstddef>
#include <cstdlib>
#include <exception>
#include <new>
#include <string>

#include <pthread.h>
#include <sys/resource.h>

#include <CLI/CLI.hpp>

#include "command/command_line.h"
#include "command/registry.h"
#include "command/terminal.h"

namespace sheave::command {
namespace {

ExitCode dispatch(int argc, char** argv) {
  const CommandLine line;
  if (!parse_command_line(*line.app, argc, argv)) return ExitCode::done;
  for (std::size_t i = 0; i < commands().size(); ++i) {
    if (line.app->got_subcommand(commands()[i].name)) return line.actions[i]();
  }
  return ExitCode::internal;
}

void print_internal_error(const char* what) {
  try {
    print_error(std::string("internal: ") + what);
  } catch (const std::bad_alloc&) {
    print_error("out of memory");
  }
}

/// The only way in which the command ends.
ExitCode run_command_line(int argc, char** argv) {
  try {
    return dispatch(argc, argv);
  } catch (const Failure& failure) {
    print_error(failure.what());
    return failure.code();
  } catch (const std::bad_alloc&) {
    print_error("out of memory");
  } catch (const std::exception& error) {
    print_internal_error(error.what());
  }
  return ExitCode::internal;
}

/// Ends the process after an exception that left a destructor or a noexcept function, as lack of
/// memory may in libraries. Stack unwinding is impossible then, but the message is still printed.
[[noreturn]] void end_at_once() noexcept {
  try {
    if (const std::exception_ptr failure = std::current_exception()) {
      std::rethrow_exception(failure);
    }
    print_internal_error("terminated");
  } catch (const std::bad_alloc&) {
    print_error("out of memory");
  } catch (const std::exception& error) {
    print_internal_error(error.what());
  } catch (...) {
    print_internal_error("unknown exception");
  }
  std::_Exit(static_cast<int>(ExitCode::internal));
}

constexpr std::size_t least_stack = std::size_t{1} << 20U;
constexpr std::size_t good_stack = std::size_t{8} << 20U;

/// Arguments of the command, and its exit code.
struct Invocation {
  int argc = 0;
  char** argv = nullptr;
  ExitCode code = ExitCode::internal;
};

void* run_invocation(void* data) {
  auto& invocation = *static_cast<Invocation*>(data);
  invocation.code = run_command_line(invocation.argc, invocation.argv);
  return nullptr;
}

/// Runs the command. With a small limit of the stack (`ulimit -s 64`) it runs on a thread with a
/// stack of its own, as do the threads that it and its libraries start; otherwise drawing ends in a
/// segmentation fault.
ExitCode run_with_stack(Invocation& invocation) {
  rlimit stack{};
  const bool small = ::getrlimit(RLIMIT_STACK, &stack) == 0 && stack.rlim_cur < least_stack;
  pthread_attr_t attributes;
  if (!small || ::pthread_attr_init(&attributes) != 0) {
    run_invocation(&invocation);
    return invocation.code;
  }
  ::pthread_attr_setstacksize(&attributes, good_stack);
#if defined(__GLIBC__)
  ::pthread_setattr_default_np(&attributes);
#endif
  pthread_t thread{};
  const int fault = ::pthread_create(&thread, &attributes, run_invocation, &invocation);
  ::pthread_attr_destroy(&attributes);
  if (fault == 0) {
    ::pthread_join(thread, nullptr);
  } else {
    run_invocation(&invocation);
  }
  return invocation.code;
}

}  // namespace
}  // namespace sheave::command

int main(int argc, char** argv) {
  sheave::command::turn_signals_into_errors();
  std::set_terminate(sheave::command::end_at_once);
  sheave::command::Invocation invocation{argc, argv};
  return static_cast<int>(sheave::command::run_with_stack(invocation));
}
