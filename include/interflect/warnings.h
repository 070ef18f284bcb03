#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace interflect {

/// Valid but unsupported input, with one counted entry per kind.
class Warnings {
  public:
    struct Entry {
        std::string kind;     ///< Stable identifier, such as "unsupported-entity"; several messages may share it.
        std::string message;  ///< One sentence for the user.
        std::string where;    ///< "file:line" of the first occurrence; may be empty.
        std::int64_t count = 0;
    };

    /// Counts one more occurrence of (kind, message); keeps the first `where`.
    void add(const std::string& kind, const std::string& message, const std::string& where = {});
    const std::vector<Entry>& entries() const { return entries_; }  ///< In order of first occurrence.

  private:
    std::vector<Entry> entries_;
};

}  // namespace interflect
