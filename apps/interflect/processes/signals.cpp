#include "apps/interflect/processes/signals.h"

#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <ctime>

#include "interflect/base/files/pending_file.h"

namespace interflect::command {

using namespace detail;

namespace {

constexpr std::array stop_signals = {SIGINT, SIGTERM, SIGHUP, SIGUSR1};
std::atomic<bool> first_only_stops{false};  // whether the first signal requests a stop instead of ending the process
std::atomic<bool> stop_requested{false};
std::atomic<std::int64_t> first_signal{0};  // time of the signal that requested the stop [ns]; 0 before
// Signal handlers require this
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<std::int64_t>::is_always_lock_free);

/// Signals that follow the first one within this time are copies of it [ns]: `timeout` and some shells and launchers
/// signal a process and then its group. People need longer to press Ctrl-C again.
constexpr std::int64_t copies_within = 250'000'000;

std::int64_t now() {
    std::timespec time{};
    ::clock_gettime(CLOCK_MONOTONIC, &time);
    return std::int64_t{1'000'000'000} * time.tv_sec + time.tv_nsec;
}

void say(const char* text) { [[maybe_unused]] const auto written = ::write(STDERR_FILENO, text, std::strlen(text)); }

/// Ends the process as the signal would without a handler.
void end_process(int signal) {
    remove_temporary_files();
    if (::isatty(STDERR_FILENO) == 1) say("\n");  // below a progress bar
    say("ended by a signal, without a result\n");
    std::signal(signal, SIG_DFL);
    ::raise(signal);  // delivered when the handler returns
}

extern "C" void handle_stop_signal(int signal) {
    if (!first_only_stops) return end_process(signal);
    const std::int64_t time = now();
    std::int64_t first = 0;
    if (!first_signal.compare_exchange_strong(first, time)) {  // sets `first`
        if (time - first > copies_within) end_process(signal);
        return;
    }
    stop_requested = true;
    const int errno_before = errno;
    if (::isatty(STDERR_FILENO) == 1) say("\n");  // below a progress bar
    say("stopping, and keeping usable results; the same signal again ends at once, without results\n");
    errno = errno_before;
}

bool is_ignored(int signal) {
    struct sigaction action {};
    return ::sigaction(signal, nullptr, &action) == 0 && action.sa_handler == SIG_IGN;
}

}  // namespace

void handle_signals() {
    struct sigaction action {};
    action.sa_handler = handle_stop_signal;
    action.sa_flags = SA_RESTART;
    for (const int signal : stop_signals) ::sigaddset(&action.sa_mask, signal);
    for (const int signal : stop_signals)
        if (signal != SIGHUP || !is_ignored(signal)) ::sigaction(signal, &action, nullptr);
    std::signal(SIGPIPE, SIG_IGN);
    std::signal(SIGXFSZ, SIG_IGN);
}

void stop_on_signal() { first_only_stops = true; }

void ignore_stop_signals() {
    for (const int signal : stop_signals) std::signal(signal, SIG_IGN);
}

void end_on_signal() { first_only_stops = false; }

const std::atomic<bool>& stop_flag() { return stop_requested; }

bool is_stop_requested() { return stop_requested; }

}  // namespace interflect::command
