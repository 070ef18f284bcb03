#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace interflect {

/// What is valid but unsupported: one counted entry per kind, so that ten thousand of them make one line.
class Warnings {
  public:
    struct Entry {
        std::string kind;     ///< Stable identifier, such as "unsupported-entity"; several messages may share it.
        std::string message;  ///< One sentence for people.
        std::string where;    ///< "file:line" of the first occurrence; may be empty.
        std::int64_t count = 0;
    };

    /// Counts one more of (kind, message); `where` is kept from the first.
    void add(const std::string& kind, const std::string& message, const std::string& where = {});
    const std::vector<Entry>& entries() const { return entries_; }  ///< In order of first occurrence.

  private:
    std::vector<Entry> entries_;
};

}  // namespace interflect
