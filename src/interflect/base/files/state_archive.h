#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <list>
#include <map>
#include <span>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace interflect::detail {

/// State of a run as named byte arrays in native layout, for the same version only. archive() both writes and reads.
/// It refuses invalid numbers, with which a run would crash or never end.
class StateArchive {
  public:
    /// Makes an archive for writing. Writing refers to the caller's values, which must not change until written.
    StateArchive() = default;
    /// Makes an archive for reading.
    explicit StateArchive(std::map<std::string, std::vector<std::byte>> arrays)
        : reads_(true), arrays_(std::move(arrays)) {}

    /// Numbers that are read must be finite, integers also non-negative. Owners of other types check their members.
    template <class T>
    void operator()(const std::string& name, T& values) {
        unchecked(name, values);
        if (reads_) require_range(are_all(values, [](auto number) { return is_regular(number); }), name);
    }
    /// Archives values whose numbers must be non-negative, otherwise as operator().
    template <class T>
    void amounts(const std::string& name, T& values) {
        (*this)(name, values);
        if (reads_) require_range(are_all(values, [](auto number) { return number >= decltype(number){0}; }), name);
    }

    template <class T>
    void unchecked(const std::string& name, T& value) {
        static_assert(std::is_standard_layout_v<T> && !std::is_pointer_v<T>);
        const std::span bytes(reinterpret_cast<std::byte*>(&value), sizeof(T));
        if (!reads_)
            spans_.emplace_back(name, bytes);
        else
            copy(taken(name), bytes, name);
    }
    void unchecked(const std::string& name, bool& value) {
        const std::uint8_t byte = by_value(name, std::vector{static_cast<std::uint8_t>(value)}).at(0);
        if (!reads_) return;  // without an assignment, because several threads may write one state
        require_range(byte <= 1, name);
        value = byte == 1;
    }
    template <class T>
    void unchecked(const std::string& name, std::vector<T>& values) {
        static_assert(std::is_standard_layout_v<T> && !std::is_pointer_v<T>);
        if (reads_) {
            const std::vector<std::byte> bytes = taken(name);
            values.resize(bytes.size() / sizeof(T));
            copy(bytes, std::as_writable_bytes(std::span(values)), name);
        } else {
            spans_.emplace_back(name, std::as_writable_bytes(std::span(values)));
        }
    }

    /// @throws std::runtime_error naming the array, unless its numbers are in range.
    static void require_range(bool holds, const std::string& name) {
        if (!holds) throw std::runtime_error("the state of the run has numbers out of range in '" + name + "'");
    }

    /// Writes and returns `values`, or returns the values read, unchecked.
    template <class T>
    std::vector<T> by_value(const std::string& name, std::vector<T> values) {
        if (!reads_) {
            const auto bytes = std::as_bytes(std::span(values));
            copies_.emplace_back(bytes.begin(), bytes.end());
            spans_.emplace_back(name, copies_.back());
        } else {
            unchecked(name, values);
        }
        return values;
    }

    bool reads() const { return reads_; }
    const std::vector<std::pair<std::string, std::span<const std::byte>>>& written() const { return spans_; }

  private:
    template <class Number>
    static bool is_regular(Number number) {
        if constexpr (std::is_floating_point_v<Number>) return std::isfinite(number);
        return number >= Number{0};
    }
    /// Tests a number, or all numbers of an array or of a vector in space; true for other types.
    template <class T, class Test>
    static bool are_all(const T& value, const Test& test) {
        if constexpr (std::is_arithmetic_v<T>) {
            return test(value);
        } else if constexpr (requires { value.begin(); }) {
            return std::all_of(value.begin(), value.end(), [&](const auto& part) { return are_all(part, test); });
        } else if constexpr (requires { T::dimensions(); }) {
            for (unsigned k = 0; k < T::dimensions(); ++k)
                if (!test(value[static_cast<int>(k)])) return false;
            return true;
        } else {
            return true;
        }
    }

    /// @throws std::runtime_error if the array is missing.
    std::vector<std::byte> taken(const std::string& name) {
        const auto found = arrays_.find(name);
        if (found == arrays_.end()) throw std::runtime_error("the state of the run lacks '" + name + "'");
        return std::move(arrays_.extract(found).mapped());
    }
    static void copy(std::span<const std::byte> from, std::span<std::byte> to, const std::string& name) {
        if (from.size() != to.size())
            throw std::runtime_error("the state of the run has '" + name + "' in another size");
        if (!to.empty()) std::memcpy(to.data(), from.data(), to.size());
    }

    bool reads_ = false;
    std::vector<std::pair<std::string, std::span<const std::byte>>> spans_;
    std::list<std::vector<std::byte>> copies_;  // bytes written by by_value()
    std::map<std::string, std::vector<std::byte>> arrays_;
};

template <class T>
void archive_groups(StateArchive& archive, const std::string& name, std::vector<std::vector<T>>& groups) {
    constexpr std::uint64_t most = 256;
    const std::uint64_t count = archive.by_value(name + "/count", std::vector<std::uint64_t>{groups.size()}).at(0);
    if (count > most) throw std::runtime_error("the state of the run has too many light groups");
    groups.resize(count);
    for (std::size_t g = 0; g < groups.size(); ++g) archive(name + "/" + std::to_string(g), groups[g]);
}

}  // namespace interflect::detail
