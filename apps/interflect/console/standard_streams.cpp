#include "apps/interflect/console/standard_streams.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <iostream>
#include <stdexcept>
#include <string>

namespace interflect::command {

void open_missing_standard_streams() {
    for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
        if (::fcntl(stream, F_GETFD) < 0 && errno == EBADF) {
            // The lowest free number, which open() takes, is the number of the missing stream.
            [[maybe_unused]] const int taken = ::open("/dev/null", stream == STDERR_FILENO ? O_WRONLY : O_RDONLY);
        }
}

void flush_stdout() {
    std::cout.flush();
    const bool failed = std::fflush(stdout) != 0 || std::ferror(stdout) != 0 || !std::cout;
    if (!failed) return;
    std::string reason;  // errno of an earlier failure is lost; a new write fails for the same reason
    if (::write(STDOUT_FILENO, "\n", 1) < 0) reason = std::string(": ") + std::strerror(errno);
    throw std::runtime_error("cannot write to standard output" + reason);
}

}  // namespace interflect::command
