#include "wavetank/common/standard_output.h"

#include <poll.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <string>

#include "wavetank/common/error.h"

namespace wavetank {
namespace {

bool reader_has_gone() {
  pollfd output{STDOUT_FILENO, 0, 0};
  return poll(&output, 1, 0) > 0 && (output.revents & (POLLERR | POLLHUP)) != 0;
}

}  // namespace

void let_writing_fail() {
  for (const int number : {SIGPIPE, SIGXFSZ}) std::signal(number, SIG_IGN);
}

void finish_printing() {
  errno = 0;
  const bool failed = std::fflush(stdout) != 0;
  const int problem = errno;
  if ((!failed && std::ferror(stdout) == 0) || problem == EPIPE || reader_has_gone()) return;
  throw Error(std::string("standard output does not take all of what is printed") +
              (failed && problem != 0 ? std::string(": ") + std::strerror(problem) : std::string()));
}

}  // namespace wavetank
