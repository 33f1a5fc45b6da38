// SPDX-License-Identifier: MIT
#include "lut/program/messages.h"

#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <iostream>
#include <system_error>

#include "atmosphere/text/error.h"
#include "lut/layer.h"

namespace alpenglow::lut {
namespace {

// Of standard output: the first fault's number, 0 for none.
std::atomic<int> output_fault{0};

void RememberOutputFault() {
  int none = 0;
  output_fault.compare_exchange_strong(none, errno == 0 ? EIO : errno);
}

}  // namespace

void Say(std::string_view text) noexcept {
  std::fwrite(text.data(), 1, text.size(), stderr);
  std::fflush(stderr);
}

void Print(std::string_view text) noexcept {
  errno = 0;
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size()) RememberOutputFault();
}

void FlushStandardOutput() {
  errno = 0;
  const bool streams = static_cast<bool>(std::cout.flush());
  if (!streams || std::fflush(stdout) != 0 || std::ferror(stdout) != 0) RememberOutputFault();
  if (const int fault = output_fault.exchange(0); fault != 0) {
    throw OutputError("standard output: cannot be written: " +
                      std::generic_category().message(fault));
  }
}

void OccupyStandardDescriptors() noexcept {
  for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (fcntl(descriptor, F_GETFD) != -1 || errno != EBADF) continue;
    // Gets the lowest free number, which is this one. For reading only: a result that is printed to
    // a closed standard output is still a fault.
    static_cast<void>(open("/dev/null", O_RDONLY));
  }
}

}  // namespace alpenglow::lut
