#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <string>

#include "interflect/base/colour.h"

namespace interflect::command {

/// "20M" -> 20'000'000: a positive number, with k, M, G or T for powers of a thousand. @throws CLI::ValidationError
std::int64_t parse_count(const std::string& text);
/// "2%" or "0.02" -> 0.02, above 0 and below 1. @throws CLI::ValidationError
double parse_share(const std::string& text);
/// "1,2.5,-3" -> (1, 2.5, -3). @throws CLI::ValidationError
V3f parse_vector(const std::string& text);
/// "640x360" -> {640, 360}, each from 1 to 32768. @throws CLI::ValidationError
struct Size {
    int width = 1280, height = 720;
};
Size parse_size(const std::string& text);

/// Adds an option whose text goes through one of the functions above.
template <class T>
CLI::Option* add_parsed(CLI::App& app, const std::string& name, T& value, T (*parse)(const std::string&),
                        const std::string& help) {
    return app.add_option_function<std::string>(
        name, [&value, parse](const std::string& text) { value = parse(text); }, help);
}

}  // namespace interflect::command
