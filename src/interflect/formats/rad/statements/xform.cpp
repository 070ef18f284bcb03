#include "interflect/formats/rad/statements/xform.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace interflect::detail {

namespace {

std::optional<std::size_t> number_count(std::string_view option) {
    if (option == "-t") return 3;
    if (option == "-mx" || option == "-my" || option == "-mz") return 0;
    for (const std::string_view one : {"-rx", "-ry", "-rz", "-s", "-i", "-a"})
        if (option == one) return 1;
    return std::nullopt;
}

}  // namespace

std::string RadXform::prefix(const std::vector<int>& copy) const {
    if (copy.empty()) return name;
    return fmt::format("{}{}", name.empty() ? "a" : name + '.', fmt::join(copy, "."));
}

std::optional<std::vector<std::vector<std::string>>> parse_pipeline(std::string_view command) {
    constexpr std::string_view special = "&;<>()$`\\*?[]{}#~!\n";
    std::vector<std::vector<std::string>> commands(1);
    bool in_word = false;
    char quote = '\0';
    for (const char c : command) {
        // Refuse characters that a shell interprets, outside quotes and inside double quotes
        if (quote == '\'' ? false : quote ? c == '$' || c == '`' || c == '\\' : special.find(c) != special.npos)
            return std::nullopt;
        if (!quote && c == '|') {
            commands.emplace_back();
            in_word = false;
            continue;
        }
        const bool is_blank = !quote && (c == ' ' || c == '\t' || c == '\r');
        if (!is_blank && !in_word) commands.back().emplace_back();
        in_word = !is_blank;
        if (quote ? c == quote : c == '"' || c == '\'')
            quote = quote ? '\0' : c;
        else if (!is_blank)
            commands.back().back() += c;
    }
    if (quote || std::any_of(commands.begin(), commands.end(), [](const auto& words) { return words.empty(); }))
        return std::nullopt;
    return commands;
}

std::optional<RadXform> parse_xform(std::span<const std::string> words) {
    if (words.front() != "xform") return std::nullopt;
    // Read the options before the transform
    const std::vector<std::string_view> arguments(words.begin() + 1, words.end());
    std::size_t i = 0;
    std::string name, modifier;
    bool inverts = false;
    for (; i < arguments.size(); ++i) {
        const std::string_view option = arguments[i];
        if (option == "-I") {
            inverts = !inverts;
        } else if ((option == "-n" || option == "-m") && i + 1 < arguments.size()) {
            const std::string value(arguments[++i]);
            if (option == "-n") name += (name.empty() ? "" : ".") + value;
            if (option == "-m" && modifier.empty()) modifier = value;
        } else if (option != "-e" && option != "-c") {
            break;
        }
    }
    // Find the end of the transform, after which the files follow
    std::size_t end = i;
    while (end < arguments.size() && arguments[end].starts_with('-')) {
        const auto numbers = number_count(arguments[end]);
        if (!numbers) {
            if (arguments[end] == "-f") return std::nullopt;
            if (arguments[end] == "-" && end + 1 == arguments.size()) break;
            throw std::invalid_argument(fmt::format("'{}' is no option of xform", arguments[end]));
        }
        end += 1 + *numbers;
    }
    if (end > arguments.size()) throw std::invalid_argument("the transform of xform is cut off");
    const bool reads_input = end + 1 == arguments.size() && arguments[end] == "-";
    return RadXform{name,
                    modifier,
                    inverts,
                    TransformSequence(std::span(arguments).subspan(i, end - i)),
                    {arguments.begin() + static_cast<std::ptrdiff_t>(end + (reads_input ? 1 : 0)), arguments.end()}};
}

}  // namespace interflect::detail
