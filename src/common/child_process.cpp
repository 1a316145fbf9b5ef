#include "wavetank/common/child_process.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <new>
#include <optional>

#include "wavetank/common/ending_signals.h"
#include "wavetank/common/error.h"

namespace wavetank {
namespace {

using ChildClock = std::chrono::steady_clock;

// What a child says first.
constexpr char did_it = 'd', refused_it = 'r', had_no_memory = 'm';

/// Bytes of address space that this process has.
std::uint64_t present_memory() {
  unsigned long long pages = 0;
  std::FILE* file = std::fopen("/proc/self/statm", "r");
  if (file == nullptr) return 0;
  if (std::fscanf(file, "%llu", &pages) != 1) pages = 0;
  std::fclose(file);
  return pages * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

void lower_limit(__rlimit_resource resource, rlim_t wanted) {
  rlimit limit;
  if (getrlimit(resource, &limit) != 0) return;
  limit.rlim_cur = std::min(wanted, limit.rlim_cur);
  setrlimit(resource, &limit);
}

void tell(int pipe_end, char first, const std::string& bytes) {
  const std::uint64_t length = bytes.size();
  std::string text(1, first);
  text.append(reinterpret_cast<const char*>(&length), sizeof length);
  text += bytes;
  for (std::size_t at = 0; at < text.size();) {
    const ssize_t written = write(pipe_end, text.data() + at, text.size() - at);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return;
    at += static_cast<std::size_t>(written);
  }
}

/// Of the child: its limits, and nothing heard of it but by the pipe.
void settle_in(pid_t parent, const ChildLimits& limits) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(1);
  for (const int number : {SIGSEGV, SIGBUS, SIGABRT, SIGFPE, SIGILL, SIGTRAP, SIGPROF, SIGPIPE}) std::signal(number, SIG_DFL);
  sigset_t heard;
  sigemptyset(&heard);
  sigaddset(&heard, SIGPROF);
  pthread_sigmask(SIG_UNBLOCK, &heard, nullptr);
  const int nowhere = open("/dev/null", O_WRONLY);
  if (nowhere >= 0) {
    dup2(nowhere, STDOUT_FILENO);
    dup2(nowhere, STDERR_FILENO);
  }
  lower_limit(RLIMIT_CORE, 0);
  lower_limit(RLIMIT_AS, present_memory() + limits.memory);
  lower_limit(RLIMIT_STACK, 64u << 20);
  itimerval timer{};
  timer.it_value.tv_sec = static_cast<time_t>(limits.processor_seconds);
  timer.it_value.tv_usec = static_cast<suseconds_t>(1e6 * (limits.processor_seconds - std::floor(limits.processor_seconds)));
  setitimer(ITIMER_PROF, &timer, nullptr);
}

[[noreturn]] void be_the_child(int pipe_end, pid_t parent, const std::function<std::string()>& work, const ChildLimits& limits) {
  settle_in(parent, limits);
  try {
    tell(pipe_end, did_it, work());
  } catch (const std::bad_alloc&) {
    tell(pipe_end, had_no_memory, "");
  } catch (const std::exception& failure) {
    tell(pipe_end, refused_it, failure.what());
  } catch (...) {
    tell(pipe_end, refused_it, "an error without a name");
  }
  _exit(0);  // without what others have asked to be done at the end of this process
}

/// Why nobody listens to a child any more.
enum class Hearing { to_its_end, out_of_time, interrupted };

/// All that the child says.
Hearing hear(int pipe_end, ChildClock::time_point end, std::string& bytes) {
  constexpr long long lap = 100;  // ms, in which a request to end is heard
  char block[65536];
  while (true) {
    if (EndingSignals::heard()) return Hearing::interrupted;
    const long long left = std::chrono::duration_cast<std::chrono::milliseconds>(end - ChildClock::now()).count();
    if (left <= 0) return Hearing::out_of_time;
    pollfd awaited{pipe_end, POLLIN, 0};
    if (poll(&awaited, 1, static_cast<int>(std::min(left, lap))) <= 0) continue;
    const ssize_t length = read(pipe_end, block, sizeof block);
    if (length < 0 && errno == EINTR) continue;
    if (length <= 0) return Hearing::to_its_end;
    bytes.append(block, static_cast<std::size_t>(length));
  }
}

std::string seconds_text(double seconds) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g s", seconds);
  return text;
}

/// `status`: none where it is not known how it ended, as where the process that began this one has SIGCHLD ignored.
ChildResult result_of(std::optional<int> status, const std::string& said, const ChildLimits& limits) {
  using End = ChildResult::End;
  if (status && WIFSIGNALED(*status)) {
    const int number = WTERMSIG(*status);
    if (number == SIGPROF) return {End::out_of_time, seconds_text(limits.processor_seconds) + " of processor time"};
    if (number == SIGXCPU) return {End::out_of_time, "processor time that this process was started with (ulimit -t)"};
    return {End::crashed, number == SIGKILL ? "killed from outside, as a system does that runs out of memory" : strsignal(number)};
  }
  constexpr std::size_t head = 1 + sizeof(std::uint64_t);
  std::uint64_t length = 0;
  if (said.size() >= head) std::memcpy(&length, said.data() + 1, sizeof length);
  if (said.size() < head || said.size() - head != length)  // however it ended, a message that is whole is what it had to say
    return {End::crashed, said.empty() ? "exit without a word" : "exit in the middle of its words"};
  const std::string rest = said.substr(head);
  if (said[0] == did_it) return {End::done, rest};
  return said[0] == had_no_memory ? ChildResult{End::out_of_memory, ""} : ChildResult{End::refused, rest};
}

}  // namespace

ChildResult run_in_child(const std::function<std::string()>& work, const ChildLimits& limits) {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) throw Error(std::string("no pipe to a process of its own: ") + std::strerror(errno));
  const pid_t parent = getpid(), child = fork();
  if (child == 0) {
    close(ends[0]);
    be_the_child(ends[1], parent, work, limits);
  }
  const int problem = errno;
  close(ends[1]);
  if (child < 0) {
    close(ends[0]);
    throw Error(std::string("no process of its own can be started: ") + std::strerror(problem));
  }
  std::string said;
  const auto end = ChildClock::now() + std::chrono::duration_cast<ChildClock::duration>(std::chrono::duration<double>(limits.seconds));
  const Hearing hearing = hear(ends[0], end, said);
  if (hearing != Hearing::to_its_end) kill(child, SIGKILL);
  close(ends[0]);
  int status = 0;
  pid_t ended;
  do {
    ended = waitpid(child, &status, 0);
  } while (ended < 0 && errno == EINTR);
  if (hearing == Hearing::interrupted) return {ChildResult::End::interrupted, ""};
  if (hearing == Hearing::out_of_time) return {ChildResult::End::out_of_time, seconds_text(limits.seconds)};
  return result_of(ended == child ? std::optional<int>(status) : std::nullopt, said, limits);
}

}  // namespace wavetank
