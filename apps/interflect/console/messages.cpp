#include "apps/interflect/console/messages.h"

#include <spdlog/pattern_formatter.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <memory>
#include <string_view>

namespace interflect::command {

namespace {

constexpr std::string_view indented_line = "\n  ";

std::string escaped_lines(std::string_view text) {
    std::string result;
    for (auto end = text.find(indented_line); end != std::string_view::npos; end = text.find(indented_line)) {
        result += detail::escaped(text.substr(0, end)).append(indented_line);
        text.remove_prefix(end + indented_line.size());
    }
    return result + detail::escaped(text);
}

/// Flag of spdlog's pattern that inserts the escaped message.
class EscapedMessage : public spdlog::custom_flag_formatter {
  public:
    static constexpr char flag = '*';
    void format(const spdlog::details::log_msg& message, const std::tm&, spdlog::memory_buf_t& line) override {
        const std::string text = escaped_lines({message.payload.data(), message.payload.size()});
        line.append(text.data(), text.data() + text.size());
    }
    std::unique_ptr<custom_flag_formatter> clone() const override { return std::make_unique<EscapedMessage>(); }
};

}  // namespace

void log_to_stderr() {
    spdlog::set_default_logger(spdlog::stderr_color_st("interflect"));
    auto formatter = std::make_unique<spdlog::pattern_formatter>();
    formatter->add_flag<EscapedMessage>(EscapedMessage::flag).set_pattern("%^%l%$: %*");
    spdlog::set_formatter(std::move(formatter));
}

}  // namespace interflect::command
