#pragma once

#include <gtest/gtest.h>

#include <string>

#include "interflect/core.h"

namespace interflect::testing_support {

/// Returns the message of the InputError, or "no error".
template <class Read>
std::string message_of(const Read& read) {
    try {
        read();
    } catch (const InputError& error) {
        return error.what();
    }
    return "no error";
}

inline void expect_in(const std::string& message, const std::string& part) {
    EXPECT_NE(message.find(part), std::string::npos) << "'" << part << "' is not in: " << message;
}

struct BadText {
    const char* name;
    std::string text;
    const char* expected;  // part of the message
};
inline void PrintTo(const BadText& bad, std::ostream* out) { *out << bad.name; }

/// Returns Fault::setting of the InputError that `call` throws.
template <class Call>
std::string refused_setting(const Call& call) {
    try {
        call();
    } catch (const InputError& error) {
        return error.fault().setting;
    }
    return "no error";
}

}  // namespace interflect::testing_support
