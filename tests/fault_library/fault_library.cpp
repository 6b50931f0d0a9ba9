// Preloaded into the command (LD_PRELOAD): lets the n-th of its output calls, or of its
// allocations, fail, and records the calls.
//
//   SHEAVE_FAULT_AT=n        the n-th output call fails, counted from 1; 0 or not set: none
//   SHEAVE_FAULT_STAYS=1     and all after it, as on a disk that is full
//   SHEAVE_FAULT_NEW=n       the n-th call of operator new fails; with SHEAVE_FAULT_STAYS all after it
//                            Counted from the first call of signal(), with which main() begins: nobody can catch what static
//                            objects of libraries throw before
//   SHEAVE_FAULT_PROGRAMS=path   every program that starts, the command and all that come of it: its file, one a line
//   SHEAVE_FAULT_LOG=path    the calls, one per record (see Record)
//
// Output calls are those that bring something to a disk or start a program; standard error is left
// alone, for it tells what happened. Programs that the command starts are not touched, unless they
// are to tell their names.

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdarg>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <new>

#include <dlfcn.h>
#include <fcntl.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace {

// NOLINTBEGIN(cppcoreguidelines-avoid-non-const-global-variables): a preloaded library has no other place.
std::atomic<long> calls{0};
std::atomic<long> allocations{0};
long fault_at = 0;
long fault_new = 0;
bool stays = false;
std::atomic<bool> main_runs{false};
int log_file = -1;
// NOLINTEND(cppcoreguidelines-avoid-non-const-global-variables)

long number_of(const char* name) {
  const char* text = std::getenv(name);
  return text == nullptr ? 0 : std::strtol(text, nullptr, 10);
}

void tell_program(const char* path) {
  char name[4097];
  const ssize_t length = ::readlink("/proc/self/exe", name, sizeof name - 1);
  if (length < 0) return;
  name[length] = '\n';
  const auto file =
      static_cast<int>(::syscall(SYS_open, path, O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666));
  ::syscall(SYS_write, file, name, static_cast<std::size_t>(length) + 1);
  ::syscall(SYS_close, file);
}

__attribute__((constructor)) void read_environment() {
  fault_at = number_of("SHEAVE_FAULT_AT");
  fault_new = number_of("SHEAVE_FAULT_NEW");
  stays = number_of("SHEAVE_FAULT_STAYS") != 0;
  if (const char* path = std::getenv("SHEAVE_FAULT_LOG")) {
    log_file = static_cast<int>(
        ::syscall(SYS_open, path, O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666));
  }
  // However a program is started, it has to load this library first, and says its name.
  if (const char* path = std::getenv("SHEAVE_FAULT_PROGRAMS")) {
    tell_program(path);
  } else {
    ::unsetenv("LD_PRELOAD");
  }
}

__attribute__((destructor)) void tell_allocations() {
  if (log_file < 0) return;
  char line[64];
  const int length =
      std::snprintf(line, sizeof line, "end %ld %ld 0 0\n", calls.load(), allocations.load());
  ::syscall(SYS_write, log_file, line, static_cast<std::size_t>(length));
}

/// A record: the call, a descriptor or -1, an offset or -1, the length of a first and of a second
/// text, a line break; the texts.
void record(const char* call, int descriptor, long offset, const void* first,
            std::size_t first_size, const void* second = nullptr, std::size_t second_size = 0) {
  if (log_file < 0) return;
  char line[128];
  const int length = std::snprintf(line, sizeof line, "%s %d %ld %zu %zu\n", call, descriptor,
                                   offset, first_size, second_size);
  ::syscall(SYS_write, log_file, line, static_cast<std::size_t>(length));
  ::syscall(SYS_write, log_file, first, first_size);
  ::syscall(SYS_write, log_file, second, second_size);
}

/// Counts a call; true if it is to fail.
bool fails(int reason) {
  const long now = ++calls;
  if (fault_at == 0 || (stays ? now < fault_at : now != fault_at)) return false;
  errno = reason;
  return true;
}

template <class Function>
Function next(const char* name) {
  return reinterpret_cast<Function>(::dlsym(RTLD_NEXT, name));  // NOLINT(*-reinterpret-cast)
}

void* allocate(std::size_t size) {
  const long now = main_runs ? ++allocations : 0;
  const bool fault = fault_new != 0 && (now > 0 && (stays ? now >= fault_new : now == fault_new));
  return fault ? nullptr : std::malloc(size == 0 ? 1 : size);
}

}  // namespace

extern "C" {

sighandler_t signal(int number, sighandler_t handler) noexcept {
  main_runs = true;
  return next<sighandler_t (*)(int, sighandler_t)>("signal")(number, handler);
}

ssize_t write(int descriptor, const void* bytes, size_t size) {
  if (descriptor != STDERR_FILENO) {
    // A disk that fills up takes a part first; every other fault does so too.
    if (fails(ENOSPC)) {
      if (size < 2 || calls % 2 == 0) return -1;
      size /= 2;
    }
    record("write", descriptor, -1, bytes, size);
  }
  return next<decltype(&write)>("write")(descriptor, bytes, size);
}

ssize_t pwrite(int descriptor, const void* bytes, size_t size, off_t offset) {
  if (fails(ENOSPC)) return -1;
  record("pwrite", descriptor, offset, bytes, size);
  return next<decltype(&pwrite)>("pwrite")(descriptor, bytes, size, offset);
}

ssize_t send(int descriptor, const void* bytes, size_t size, int flags) {
  if (fails(EPIPE)) return -1;
  return next<decltype(&send)>("send")(descriptor, bytes, size, flags);
}

int ftruncate(int descriptor, off_t size) noexcept {
  if (fails(EIO)) return -1;
  record("ftruncate", descriptor, size, nullptr, 0);
  return next<int (*)(int, off_t)>("ftruncate")(descriptor, size);
}

int fsync(int descriptor) {
  if (fails(EIO)) return -1;
  record("fsync", descriptor, -1, nullptr, 0);
  return next<decltype(&fsync)>("fsync")(descriptor);
}

int rename(const char* from, const char* to) noexcept {
  if (fails(EIO)) return -1;
  record("rename", -1, -1, from, std::strlen(from), to, std::strlen(to));
  return next<int (*)(const char*, const char*)>("rename")(from, to);
}

int unlink(const char* path) noexcept {
  record("unlink", -1, -1, path, std::strlen(path));
  return next<int (*)(const char*)>("unlink")(path);
}

int mkostemp(char* pattern, int flags) {
  if (fails(ENOSPC)) return -1;
  const int result = next<decltype(&mkostemp)>("mkostemp")(pattern, flags);
  record("create", result, -1, pattern, std::strlen(pattern));
  return result;
}

int mkostemps(char* pattern, int suffix, int flags) {
  if (fails(ENOSPC)) return -1;
  const int result = next<decltype(&mkostemps)>("mkostemps")(pattern, suffix, flags);
  record("create", result, -1, pattern, std::strlen(pattern));
  return result;
}

int open(const char* path, int flags, ...) {
  mode_t mode = 0;
  if ((flags & O_CREAT) != 0) {
    va_list arguments;
    va_start(arguments, flags);
    mode = va_arg(arguments, mode_t);
    va_end(arguments);
  }
  const bool writes = (flags & O_ACCMODE) != O_RDONLY;
  if (writes && fails(EACCES)) return -1;
  const int result = next<int (*)(const char*, int, ...)>("open")(path, flags, mode);
  record("open", result, -1, path, std::strlen(path));
  return result;
}

/// Whatever it says, the descriptor is closed.
int close(int descriptor) {
  record("close", descriptor, -1, nullptr, 0);
  // Of descriptors that are only read nobody asks.
  const bool writes = (::fcntl(descriptor, F_GETFL) & O_ACCMODE) != O_RDONLY;
  const int result = next<decltype(&close)>("close")(descriptor);
  return writes && fails(EIO) ? -1 : result;
}

int posix_spawnp(pid_t* process, const char* file, const posix_spawn_file_actions_t* actions,
                 const posix_spawnattr_t* attributes, char* const arguments[],
                 char* const environment[]) {
  if (fails(EAGAIN)) return EAGAIN;
  return next<decltype(&posix_spawnp)>("posix_spawnp")(process, file, actions, attributes,
                                                       arguments, environment);
}

}  // extern "C"

#ifndef SHEAVE_FAULT_NO_NEW

void* operator new(std::size_t size) {
  void* place = allocate(size);
  if (place == nullptr) throw std::bad_alloc();
  return place;
}
void* operator new[](std::size_t size) { return operator new(size); }
void* operator new(std::size_t size, const std::nothrow_t& /*tag*/) noexcept {
  return allocate(size);
}
void operator delete(void* place) noexcept { std::free(place); }
void operator delete[](void* place) noexcept { std::free(place); }
void operator delete(void* place, std::size_t /*size*/) noexcept { std::free(place); }
void operator delete[](void* place, std::size_t /*size*/) noexcept { std::free(place); }

#endif
