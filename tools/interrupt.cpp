#include "tools/interrupt.h"

#include <atomic>
#include <csignal>

namespace sheave::tools {
namespace {

std::atomic<bool>& flag() {
  static std::atomic<bool> raised{false};
  return raised;
}
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler must not wait");

void raise_flag(int /*signal*/) { flag() = true; }

void catch_signal(int signal) {
  struct sigaction action {};
  action.sa_handler = raise_flag;
  sigemptyset(&action.sa_mask);
  // No SA_RESTART: a write that waits for a slow reader must notice.
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  ::sigaction(signal, &action, nullptr);
}

}  // namespace

void catch_interrupts() {
  catch_signal(SIGINT);
  catch_signal(SIGTERM);
  struct sigaction hangup {};
  ::sigaction(SIGHUP, nullptr, &hangup);
  if (hangup.sa_handler != SIG_IGN) catch_signal(SIGHUP);
}

bool interrupted() { return flag(); }

}  // namespace sheave::tools
