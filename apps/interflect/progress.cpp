#include "apps/interflect/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstdio>

#include "apps/interflect/percent.h"

namespace interflect::command {

namespace {

constexpr int bar_width = 24;
constexpr double seconds_between_lines = 2;  // where stderr is no terminal

std::atomic<bool> stop_requested{false};
static_assert(std::atomic<bool>::is_always_lock_free);  // so that a signal handler may set it

std::string_view stop_notice;  // set before the signal handler is

extern "C" void request_stop(int signal) {
    stop_requested = true;
    std::signal(signal, SIG_DFL);  // a second one ends the process
    const int errno_before = errno;
    [[maybe_unused]] const auto written = ::write(STDERR_FILENO, stop_notice.data(), stop_notice.size());
    errno = errno_before;
}

bool stderr_is_terminal() { return ::isatty(STDERR_FILENO) == 1; }

}  // namespace

StopOnInterrupt::StopOnInterrupt(std::string_view notice) {
    stop_requested = false;
    stop_notice = notice.substr(stderr_is_terminal() ? 0 : 1);
    std::signal(SIGINT, request_stop);
    std::signal(SIGTERM, request_stop);
}

StopOnInterrupt::~StopOnInterrupt() {
    std::signal(SIGINT, SIG_DFL);
    std::signal(SIGTERM, SIG_DFL);
}

const std::atomic<bool>& StopOnInterrupt::flag() { return stop_requested; }

std::string duration(double seconds) {
    if (seconds < 60) return fmt::format("{:.1f} s", seconds);
    const auto whole = static_cast<std::int64_t>(std::min(seconds, 1e15));
    if (whole < 3600) return fmt::format("{} min {} s", whole / 60, whole % 60);
    return fmt::format("{} h {} min", whole / 3600, whole / 60 % 60);
}

std::string magnitude(double number) {
    for (const char* suffix : {"", " k", " M", " G"}) {
        if (number < 999.5) return *suffix ? fmt::format("{:.1f}{}", number, suffix) : fmt::format("{:.0f}", number);
        number /= 1000;
    }
    return fmt::format("{:.1f} T", number);
}

double fraction_done(const SolveOptions& options, const IterationReport& report) {
    double fraction = static_cast<double>(report.rays) / static_cast<double>(options.rays);
    if (std::isfinite(options.seconds)) fraction = std::max(fraction, report.seconds / options.seconds);
    if (options.until > 0) fraction = std::max(fraction, std::pow(options.until / report.error_estimate, 2));
    return std::clamp(fraction, 0.0, 1.0);
}

ProgressBar::ProgressBar() : terminal_(stderr_is_terminal()) {}

ProgressBar::~ProgressBar() {
    if (terminal_) fmt::print(stderr, "\n");
}

void ProgressBar::show(const WorkDone& work) {
    const double fraction = work.fraction;
    if (!terminal_ && fraction < 1 && work.seconds < last_shown_ + seconds_between_lines) return;
    last_shown_ = work.seconds;
    const std::string error = work.error ? "error " + percent(*work.error) + ", " : std::string();
    const std::string left = fraction > 0 ? duration(work.seconds / fraction * (1 - fraction)) : std::string("-");
    const std::string text =
        fmt::format("{:3.0f}%  {} rays, {}/s, {}{} left", 100 * fraction, magnitude(static_cast<double>(work.rays)),
                    magnitude(static_cast<double>(work.rays) / std::max(work.seconds, 1e-9)), error, left);
    if (!terminal_) {
        fmt::print(stderr, "{}\n", text);
        return;
    }
    const auto filled = static_cast<std::size_t>(std::lround(bar_width * fraction));
    fmt::print(stderr, "\r\x1b[K[{}{}] {}", std::string(filled, '='), std::string(bar_width - filled, ' '), text);
    std::fflush(stderr);
}

}  // namespace interflect::command
