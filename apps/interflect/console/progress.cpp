#include "apps/interflect/console/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "apps/interflect/values/percent.h"

namespace interflect::command {

namespace {

constexpr int bar_width = 24;
constexpr double seconds_between_lines = 2;  // used if stderr is not a terminal
constexpr double min_fraction = 1e-5;        // share of the work after which the remaining time is shown

}  // namespace

bool stderr_is_terminal() { return ::isatty(STDERR_FILENO) == 1; }

void print_progress(const std::string& text) {
    std::fputs(text.c_str(), stderr);
    std::fflush(stderr);
}

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

ProgressBar::ProgressBar() : terminal_(stderr_is_terminal()) {}

ProgressBar::~ProgressBar() {
    if (terminal_)
        print_progress("\n");
    else
        print_progress(not_shown_);
}

std::string ProgressBar::time_left(const WorkDone& work) {
    if (work.fraction >= 1) return duration(0);
    if (!first_) first_ = work;
    const double done = work.fraction - first_->fraction;
    if (done < min_fraction) return "-";
    return duration((work.seconds - first_->seconds) / done * (1 - work.fraction));
}

void ProgressBar::show(const WorkDone& work) {
    const double fraction = work.fraction;
    const std::string error = work.error ? "error " + percent(*work.error) + ", " : std::string();
    const std::string text =
        fmt::format("{:3.0f}%  {} rays, {}/s, {}{} left", 100 * fraction, magnitude(static_cast<double>(work.rays)),
                    magnitude(static_cast<double>(work.rays) / std::max(work.seconds, 1e-9)), error, time_left(work));
    if (terminal_) {
        const auto filled = static_cast<std::size_t>(std::lround(bar_width * fraction));
        print_progress(
            fmt::format("\r\x1b[K[{}{}] {}", std::string(filled, '='), std::string(bar_width - filled, ' '), text));
    } else if (work.seconds < last_shown_ + seconds_between_lines) {
        not_shown_ = text + "\n";
    } else {
        print_progress(text + "\n");
        not_shown_.clear();
        last_shown_ = work.seconds;
    }
}

}  // namespace interflect::command
