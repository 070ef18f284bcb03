#include <algorithm>

#include "interflect/core.h"

namespace interflect {

namespace {

/// Limit of different messages per kind. One more entry counts all others, so a file of 300,000 faults gives a short
/// list, which is also fast to search.
constexpr std::size_t max_messages_of_kind = 100;

std::string message_of_others(const std::string& kind) {
    return "more warnings of the kind '" + kind + "', each with its own text";
}

}  // namespace

void Warnings::add(const std::string& kind, const std::string& message, const std::string& where) {
    std::size_t of_kind = 0;
    const auto is_same = [&](const Entry& e) {
        of_kind += e.kind == kind;
        return e.message == message && e.kind == kind;
    };
    auto entry = std::find_if(entries_.begin(), entries_.end(), is_same);
    if (entry == entries_.end() && of_kind == max_messages_of_kind + 1)
        entry =
            std::find_if(entries_.rbegin(), entries_.rend(), [&](const Entry& e) { return e.kind == kind; }).base() - 1;
    if (entry == entries_.end())
        entry = entries_.insert(entry,
                                {kind, of_kind < max_messages_of_kind ? message : message_of_others(kind), where, 0});
    ++entry->count;
}

}  // namespace interflect
