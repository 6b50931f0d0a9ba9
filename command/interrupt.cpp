#include "command/interrupt.h"

#include <atomic>
#include <csignal>
#include <cstdint>
#include <ctime>

namespace sheave::command {
namespace {

/// Number of accepted signals.
std::atomic<int>& signals() {
  static std::atomic<int> count{0};
  return count;
}
static_assert(std::atomic<int>::is_always_lock_free, "a signal handler must not wait");

std::atomic<std::int64_t>& last_time() {
  static std::atomic<std::int64_t> nanoseconds{0};
  return nanoseconds;
}

std::int64_t now() {
  timespec time{};
  ::clock_gettime(CLOCK_MONOTONIC, &time);  // safe in a signal handler
  return std::int64_t{time.tv_sec} * 1'000'000'000 + time.tv_nsec;
}

void raise_flag(int signal) {
  // `timeout` and some shells send one signal twice: to the process and to its group.
  if (signals() > 0 && now() - last_time() < 500'000'000) return;
  last_time() = now();
  if (++signals() <= 2) return;
  struct sigaction usual {};
  usual.sa_handler = SIG_DFL;
  ::sigaction(signal, &usual, nullptr);
  ::raise(signal);
}

void catch_signal(int signal) {
  struct sigaction action {};
  action.sa_handler = raise_flag;
  sigemptyset(&action.sa_mask);
  // No SA_RESTART: a signal must interrupt a write that waits for a slow reader.
  action.sa_flags = 0;
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

bool interrupted() { return signals() > 0; }
bool hurried() { return signals() > 1; }

}  // namespace sheave::command
