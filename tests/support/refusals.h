#pragma once

#include <string>

#include "interflect/core.h"

namespace interflect::testing_support {

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
