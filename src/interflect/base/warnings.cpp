#include "interflect/core.h"

#include <algorithm>

namespace interflect {

void Warnings::add(const std::string& kind, const std::string& message, const std::string& where) {
    const auto same = [&](const Entry& e) { return e.kind == kind && e.message == message; };
    auto entry = std::find_if(entries_.begin(), entries_.end(), same);
    if (entry == entries_.end()) entry = entries_.insert(entry, {kind, message, where, 0});
    ++entry->count;
}

}  // namespace interflect
