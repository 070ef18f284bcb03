#pragma once

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace interflect::detail {

/// Returns the number of edits between two names (Levenshtein 1965).
inline std::size_t edit_distance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t{0});
    for (std::size_t i = 0; i < a.size(); ++i) {
        std::size_t diagonal = std::exchange(row[0], i + 1);
        for (std::size_t j = 0; j < b.size(); ++j) {
            const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
            diagonal = row[j + 1];
            row[j + 1] = std::min({replaced, diagonal + 1, row[j] + 1});
        }
    }
    return row.back();
}

/// Returns a text with the most similar names. "top" is also similar to "desk.top".
inline std::string text_of_nearest(const std::string& name, std::span<const std::string> names) {
    constexpr std::size_t max_reported = 5, max_compared = 10'000;
    struct Candidate {
        std::size_t distance;
        std::string_view name;
    };
    std::vector<Candidate> candidates;
    for (const std::string& n : names.first(std::min(names.size(), max_compared))) {
        if (n.empty()) continue;
        std::size_t distance = edit_distance(name, n);
        for (std::size_t dot = n.find('.'); dot != n.npos; dot = n.find('.', dot + 1))
            distance = std::min(distance, edit_distance(name, std::string_view(n).substr(dot + 1)));
        candidates.push_back({distance, n});
    }
    if (candidates.empty()) return "no object has a name";
    std::stable_sort(candidates.begin(), candidates.end(),
                     [](const Candidate& a, const Candidate& b) { return a.distance < b.distance; });
    std::string text = "expected one of";
    for (std::size_t i = 0; i < std::min(candidates.size(), max_reported); ++i)
        text.append(i > 0 ? ", '" : " '").append(candidates[i].name).append("'");
    return candidates.size() > max_reported ? text + ", ..." : text;
}

}  // namespace interflect::detail
