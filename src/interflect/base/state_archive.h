#pragma once

#include <cstddef>
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
class StateArchive {
  public:
    /// For writing. Values must not change until written.
    StateArchive() = default;
    /// For reading.
    explicit StateArchive(std::map<std::string, std::vector<std::byte>> arrays)
        : reads_(true), arrays_(std::move(arrays)) {}

    template <class T>
    void operator()(const std::string& name, T& value) {
        static_assert(std::is_standard_layout_v<T> && !std::is_pointer_v<T>);
        const std::span bytes(reinterpret_cast<std::byte*>(&value), sizeof(T));
        if (!reads_)
            spans_.emplace_back(name, bytes);
        else
            copy(taken(name), bytes, name);
    }
    template <class T>
    void operator()(const std::string& name, std::vector<T>& values) {
        static_assert(std::is_standard_layout_v<T> && !std::is_pointer_v<T>);
        if (reads_) {
            const std::vector<std::byte> bytes = taken(name);
            values.resize(bytes.size() / sizeof(T));
            copy(bytes, std::as_writable_bytes(std::span(values)), name);
        } else {
            spans_.emplace_back(name, std::as_writable_bytes(std::span(values)));
        }
    }

    /// Writes and returns `values`, or returns the values read.
    template <class T>
    std::vector<T> by_value(const std::string& name, std::vector<T> values) {
        if (!reads_) {
            const auto bytes = std::as_bytes(std::span(values));
            copies_.emplace_back(bytes.begin(), bytes.end());
            spans_.emplace_back(name, copies_.back());
        } else {
            (*this)(name, values);
        }
        return values;
    }

    bool reads() const { return reads_; }
    const std::vector<std::pair<std::string, std::span<const std::byte>>>& written() const { return spans_; }

  private:
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
    std::list<std::vector<std::byte>> copies_;
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
