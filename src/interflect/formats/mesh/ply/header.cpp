#include "interflect/formats/mesh/ply/header.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <stdexcept>

#include "interflect/formats/text/line_reader.h"

namespace interflect::detail {

namespace {

constexpr std::size_t max_ply_properties = 256;
constexpr std::size_t max_shown = 40;  // [characters]

PlyType ply_type(std::string_view name) {
    constexpr std::pair<std::string_view, PlyType> types[] = {
        {"char", PlyType::int8},      {"int8", PlyType::int8},       {"uchar", PlyType::uint8},
        {"uint8", PlyType::uint8},    {"short", PlyType::int16},     {"int16", PlyType::int16},
        {"ushort", PlyType::uint16},  {"uint16", PlyType::uint16},   {"int", PlyType::int32},
        {"int32", PlyType::int32},    {"uint", PlyType::uint32},     {"uint32", PlyType::uint32},
        {"float", PlyType::float32},  {"float32", PlyType::float32}, {"double", PlyType::float64},
        {"float64", PlyType::float64}};
    for (const auto& [known, type] : types)
        if (known == name) return type;
    throw std::invalid_argument(fmt::format("PLY files have no type '{}'", name.substr(0, 20)));
}

PlyValues::Form ply_form(std::span<const std::string_view> words) {
    if (words.size() == 3 && words[2] == "1.0") {
        if (words[1] == "ascii") return PlyValues::Form::ascii;
        if (words[1] == "binary_little_endian") return PlyValues::Form::little_endian;
        if (words[1] == "binary_big_endian") return PlyValues::Form::big_endian;
    }
    throw std::invalid_argument("expected 'format ascii|binary_little_endian|binary_big_endian 1.0'");
}

PlyElement ply_element(std::span<const std::string_view> words) {
    PlyElement element;
    if (words.size() != 3) throw std::invalid_argument("expected 'element NAME COUNT'");
    element.name = words[1];
    const auto [end, error] = std::from_chars(words[2].data(), words[2].data() + words[2].size(), element.count);
    if (error != std::errc() || end != words[2].data() + words[2].size())
        throw std::invalid_argument(fmt::format("'{}' is no count of elements", words[2].substr(0, 40)));
    return element;
}

PlyProperty ply_property(std::span<const std::string_view> words) {
    if (words.size() == 3) return {std::string(words[2]), ply_type(words[1]), std::nullopt};
    if (words.size() != 5 || words[1] != "list")
        throw std::invalid_argument("expected 'property TYPE NAME' or 'property list TYPE TYPE NAME'");
    PlyProperty list{std::string(words[4]), ply_type(words[3]), ply_type(words[2])};
    if (*list.count_type == PlyType::float32 || *list.count_type == PlyType::float64)
        throw std::invalid_argument("the length of a list must be a whole number");
    return list;
}

}  // namespace

std::optional<std::size_t> PlyElement::find(std::string_view wanted) const {
    const auto entry =
        std::find_if(properties.begin(), properties.end(), [&](const auto& p) { return p.name == wanted; });
    return entry == properties.end() ? std::nullopt
                                     : std::optional(static_cast<std::size_t>(entry - properties.begin()));
}

std::uint64_t PlyElement::fewest_bytes() const {
    std::uint64_t bytes = 0;
    for (const PlyProperty& property : properties) bytes += size_of(property.count_type.value_or(property.type));
    return bytes;
}

PlyHeader parse_ply_header(std::string_view bytes, std::int64_t& line) {
    constexpr std::size_t longest_header = 1 << 20;
    LineReader lines(bytes.substr(0, longest_header));
    const auto next = [&] {
        const bool is_there = lines.next();
        if (is_there) line = lines.line();
        return is_there;
    };
    if (!next() || lines.words()[0] != "ply") throw std::invalid_argument("this is no PLY file");
    PlyHeader header;
    bool has_form = false;
    while (next()) {
        const auto words = lines.words();
        if (words[0] == "format") {
            header.form = ply_form(words);
            has_form = true;
        } else if (words[0] == "element") {
            header.elements.push_back(ply_element(words));
        } else if (words[0] == "property") {
            if (header.elements.empty()) throw std::invalid_argument("a property comes before the first element");
            PlyProperty property = ply_property(words);
            if (header.elements.back().find(property.name))
                throw std::invalid_argument(fmt::format("property '{}' of the element '{}' is repeated",
                                                        property.name.substr(0, max_shown),
                                                        header.elements.back().name.substr(0, max_shown)));
            header.elements.back().properties.push_back(std::move(property));
            if (header.elements.back().properties.size() > max_ply_properties)
                throw std::invalid_argument(fmt::format("an element has more than {} properties", max_ply_properties));
        } else if (words[0] == "end_header") {
            if (!has_form) throw std::invalid_argument("the header lacks a format");
            header.size = lines.position().offset;
            return header;
        } else if (words[0] != "comment" && words[0] != "obj_info") {
            header.has_unknown_lines = true;
        }
    }
    throw std::invalid_argument("the header has no end");
}

}  // namespace interflect::detail
