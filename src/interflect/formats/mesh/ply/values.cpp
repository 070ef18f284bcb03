#include "interflect/formats/mesh/ply/values.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "interflect/formats/reading/byte_order.h"
#include "interflect/formats/text/number.h"

namespace interflect::detail {

namespace {

constexpr std::string_view blanks = " \t\r\n\v\f";

}  // namespace

std::size_t size_of(PlyType type) {
    switch (type) {
        case PlyType::int8:
        case PlyType::uint8:
            return 1;
        case PlyType::int16:
        case PlyType::uint16:
            return 2;
        case PlyType::float64:
            return 8;
        default:
            return 4;
    }
}

std::optional<std::int64_t> PlyValues::lines() const {
    if (form_ != Form::ascii) return std::nullopt;
    return std::count(bytes_.begin(), bytes_.end() - static_cast<std::ptrdiff_t>(rest_.size()), '\n');
}

bool PlyValues::is_at_end() const { return rest_.find_first_not_of(blanks) == rest_.npos; }

std::optional<std::uint64_t> PlyValues::lines_left() const {
    if (form_ != Form::ascii) return std::nullopt;
    std::uint64_t count = 0;
    for (std::size_t begin = rest_.find_first_not_of(blanks); begin != rest_.npos; ++count)
        begin = rest_.find_first_not_of(blanks, std::min(rest_.find('\n', begin), rest_.size()));
    return count;
}

bool PlyValues::skip_line() {
    const std::string_view line = rest_.substr(0, rest_.find('\n'));
    rest_.remove_prefix(line.size());
    return line.find_first_not_of(blanks) != line.npos;
}

double PlyValues::next(PlyType type) {
    if (form_ == Form::ascii) return next_word();
    const std::size_t size = size_of(type);
    if (rest_.size() < size) throw std::invalid_argument("the file ends before its last value");
    const std::string_view bytes = rest_.substr(0, size);
    rest_.remove_prefix(size);
    const std::endian order = form_ == Form::little_endian ? std::endian::little : std::endian::big;
    switch (type) {
        case PlyType::int8:
            return number_of<std::int8_t>(bytes, order);
        case PlyType::uint8:
            return number_of<std::uint8_t>(bytes, order);
        case PlyType::int16:
            return number_of<std::int16_t>(bytes, order);
        case PlyType::uint16:
            return number_of<std::uint16_t>(bytes, order);
        case PlyType::int32:
            return number_of<std::int32_t>(bytes, order);
        case PlyType::uint32:
            return number_of<std::uint32_t>(bytes, order);
        case PlyType::float32:
            return number_of<float>(bytes, order);
        case PlyType::float64:
            return number_of<double>(bytes, order);
    }
    return 0;
}

double PlyValues::next_word() {
    rest_.remove_prefix(std::min(rest_.find_first_not_of(blanks), rest_.size()));
    if (rest_.empty()) throw std::invalid_argument("the file ends before its last value");
    const std::string_view word = rest_.substr(0, rest_.find_first_of(blanks));
    rest_.remove_prefix(word.size());
    const auto value = parse_number(word);
    if (!value) throw std::invalid_argument(fmt::format("expected a finite number, not '{}'", word.substr(0, 40)));
    return *value;
}

}  // namespace interflect::detail
