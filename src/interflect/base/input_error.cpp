#include <string>
#include <utility>

#include "interflect/core.h"

namespace interflect {

namespace {

std::string message_of(const Fault& fault) {
    if (fault.file.empty()) return fault.text;
    return fault.file.string() + (fault.line > 0 ? ":" + std::to_string(fault.line) : "") + ": " + fault.text;
}

}  // namespace

InputError::InputError(Fault fault) : std::runtime_error(message_of(fault)) { faults_.push_back(std::move(fault)); }

}  // namespace interflect
