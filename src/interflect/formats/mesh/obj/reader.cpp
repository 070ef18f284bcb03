#include "interflect/formats/mesh/obj/reader.h"

#include <fmt/format.h>

#include <charconv>
#include <optional>
#include <stdexcept>

#include "interflect/core.h"
#include "interflect/formats/reading/file_to_world.h"
#include "interflect/formats/text/number.h"

namespace interflect::detail {

namespace {

using Words = std::span<const std::string_view>;

double coordinate_value(std::string_view word) {
    const auto value = parse_number(word);
    if (!value) throw std::invalid_argument(fmt::format("expected a finite number, not '{}'", word));
    return *value;
}

std::optional<std::int64_t> whole_number(std::string_view text) {
    std::int64_t number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
    return number;
}

/// Returns an index, or `none` if the number is out of range.
/// @param number  Number from 1, or backwards from -1.
std::uint32_t index_of(std::int64_t number, std::size_t count) {
    const std::int64_t index = number > 0 ? number - 1 : static_cast<std::int64_t>(count) + number;
    const bool exists = number != 0 && index >= 0 && index < static_cast<std::int64_t>(count);
    return exists ? static_cast<std::uint32_t>(index) : none;
}

}  // namespace

ObjReader::ObjReader(const std::filesystem::path& path, const ReadOptions& options)
    : options_(options), materials_(model_, options_) {
    model_.file = path;
    model_.files.push_back(path.string());
    object_index_.emplace("", 0);  // the first of Model::objects
}

void ObjReader::read(std::string_view text) {
    LineReader lines(text);
    lines_ = &lines;
    while (lines.next()) {
        const Location where{&model_.file, lines.line()};
        try {
            if (const Words words = without_comment(lines.words()); !words.empty()) read_line(lines, words, where);
        } catch (const std::invalid_argument& fault) {
            throw where.error(fault);
        }
    }
}

void ObjReader::read_line(const LineReader& line, Words words, const Location& where) {
    const std::string_view key = words[0];
    // A new object, group or material begins a new mesh.
    const auto begin_mesh_named = [&] {
        if (line.rest().size() > options_.max_name_length) throw std::invalid_argument("this name is too long");
        mesh_ = none;
        return std::string(line.rest());
    };
    if (key == "v" || key == "vt" || key == "vn") {
        if (!has_all_vertices_) read_vertex_data(words, where);
        ++(key == "v" ? preceding_.positions : key == "vt" ? preceding_.coordinates : preceding_.normals);
    } else if (key == "f") {
        face(words.subspan(1), where);
    } else if (key == "o") {
        object_ = begin_mesh_named();
        group_.clear();
    } else if (key == "g") {
        group_ = begin_mesh_named();
    } else if (key == "usemtl") {
        material_ = materials_.find(begin_mesh_named(), where);
    } else if (key == "mtllib") {
        libraries(line, words, where);
    } else if (key != "s" && key != "vp") {
        const bool is_line_or_point = key == "l" || key == "p";
        model_.warnings.add(
            "unsupported-entity",
            is_line_or_point ? "lines and points are left out" : fmt::format("'{}' is left out", key.substr(0, 20)),
            where.text());
    }
}

void ObjReader::read_vertex_data(Words words, const Location& where) {
    if (words[0] == "v") vertex(words);
    if (words[0] == "vt") coordinate(words, where);
    if (words[0] == "vn") normal(words);
}

/// Reads the vertices of all lines that follow.
void ObjReader::read_ahead() {
    has_all_vertices_ = true;
    for (LineReader lines = *lines_; lines.next();) {
        const Location where{&model_.file, lines.line()};
        try {
            if (const Words words = without_comment(lines.words()); !words.empty()) read_vertex_data(words, where);
        } catch (const std::invalid_argument& fault) {
            throw where.error(fault);
        }
    }
}

/// Returns the index of a vertex, coordinate or normal.
/// @param text  Number in the whole file, from 1; or backwards from -1 in the lines before this one.
std::uint32_t ObjReader::resolved(std::string_view text, std::size_t Counts::*kind, std::string_view name,
                                  const Location& where) {
    const std::optional<std::int64_t> number = whole_number(text);
    if (!number || *number == 0)
        throw std::invalid_argument(fmt::format("expected the number of a {}, not '{}'", name, text));
    if (const std::uint32_t index = index_of(*number, preceding_.*kind); index != none) return index;
    if (*number > 0) {
        if (!has_all_vertices_) read_ahead();
        const Counts all{positions_.size(), coordinates_.size(), normals_.size()};
        if (const std::uint32_t index = index_of(*number, all.*kind); index != none) {
            model_.warnings.add("later-vertices", "faces refer to vertices of later lines", where.text());
            return index;
        }
    }
    throw std::invalid_argument(
        fmt::format("there is no {} {}: {} precede this line", name, *number, preceding_.*kind));
}

void ObjReader::vertex(Words words) {
    if (words.size() < 4) throw std::invalid_argument("a vertex needs three coordinates");
    if (positions_.size() >= none) throw std::invalid_argument("more vertices than 32 bits can count");
    positions_.emplace_back(coordinate_value(words[1]), coordinate_value(words[2]), coordinate_value(words[3]));
    uses_.emplace_back();
}

/// Reads texture coordinates. Replaces invalid ones, because exporters write NaN for degenerate faces.
void ObjReader::coordinate(Words words, const Location& where) {
    if (words.size() < 2) throw std::invalid_argument("texture coordinates need a number");
    if (coordinates_.size() >= none) throw std::invalid_argument("more texture coordinates than 32 bits can count");
    const auto u = parse_number(words[1]), v = words.size() > 2 ? parse_number(words[2]) : 0;
    if (!u || !v)
        model_.warnings.add("invalid-coordinates", "texture coordinates that are no finite numbers are read as (0, 0)",
                            where.text());
    coordinates_.push_back(u && v ? V2f(static_cast<float>(*u), static_cast<float>(*v)) : V2f(0));
}

/// Reads a normal. Invalid normals count as missing, because only shading uses them.
void ObjReader::normal(Words words) {
    if (normals_.size() >= none) throw std::invalid_argument("more normals than 32 bits can count");
    Imath::V3d n(0);
    for (int k = 0; k < 3; ++k) {
        const std::size_t word = static_cast<std::size_t>(k) + 1;
        const auto number = word < words.size() ? parse_number(words[word]) : std::nullopt;
        if (!number) {
            n = Imath::V3d(0);
            break;
        }
        n[k] = *number;
    }
    normals_.push_back(n);
}

std::uint32_t ObjReader::normal_index(std::string_view text, const Location& where) {
    const std::int64_t number = whole_number(text).value_or(0);
    std::uint32_t index = index_of(number, preceding_.normals);
    if (index == none && number > 0) {
        if (!has_all_vertices_) read_ahead();
        index = index_of(number, normals_.size());
    }
    if (index == none)
        model_.warnings.add("missing-normals", "a face refers to a normal that does not exist: it is ignored",
                            where.text());
    return index;
}

void ObjReader::face(Words words, const Location& where) {
    if (words.size() < 3) {
        model_.warnings.add("degenerate-face", "faces with fewer than three vertices are left out", where.text());
        return;
    }
    if (words.size() > options_.max_face_vertices)
        throw std::invalid_argument(
            fmt::format("a face of {} vertices; expected 3 to {}", words.size(), options_.max_face_vertices));
    if (mesh_ == none) mesh_ = mesh();
    Mesh& target = model_.meshes[mesh_];
    for (const std::string_view word : words) target.indices.push_back(corner(word, where));
    target.face_sizes.push_back(static_cast<std::uint32_t>(words.size()));
}

/// @param word  "3", "3/1", "3//2" or "-1/-1/-1".
std::uint32_t ObjReader::corner(std::string_view word, const Location& where) {
    const std::size_t slash = word.find('/');
    const std::size_t second_slash = slash == word.npos ? word.npos : word.find('/', slash + 1);
    const std::uint32_t position = resolved(word.substr(0, slash), &Counts::positions, "vertex", where);
    std::uint32_t coordinate = none;
    Mesh& target = model_.meshes[mesh_];
    const bool is_textured = model_.materials[target.material].is_textured();
    if (slash != word.npos && is_textured) {
        const std::string_view rest = word.substr(slash + 1);
        const std::string_view text = rest.substr(0, rest.find('/'));
        if (!text.empty()) coordinate = resolved(text, &Counts::coordinates, "texture coordinate", where);
    }
    const std::string_view normal_text = second_slash == word.npos ? "" : word.substr(second_slash + 1);
    const std::uint32_t normal = normal_text.empty() ? none : normal_index(normal_text, where);
    Use& use = uses_[position];
    if (use.mesh == mesh_ && use.coordinate == coordinate && use.normal == normal) return use.index;
    use = {mesh_, static_cast<std::uint32_t>(target.positions.size()), coordinate, normal};
    target.positions.push_back(positions_[position]);
    // The normals of a mesh are either none or one per vertex, 0 where the file has none.
    if (normal != none) {
        target.normals.resize(use.index, Imath::V3d(0));
        target.normals.push_back(normals_[normal]);
    } else if (!target.normals.empty()) {
        target.normals.emplace_back(0);
    }
    if (is_textured) {
        if (coordinate == none)
            model_.warnings.add("missing-coordinates",
                                "vertex of a textured face without texture coordinates has (0, 0)", where.text());
        const V2f uv = coordinate == none ? V2f(0) : coordinates_[coordinate];
        if (const std::string fault = texture_coordinate_fault(uv); !fault.empty())
            throw std::invalid_argument("this vertex " + fault);
        target.texture_coordinates.push_back(uv);
    }
    return use.index;
}

std::uint32_t ObjReader::mesh() {
    const auto [entry, is_new] =
        meshes_.try_emplace({object(), material_}, static_cast<std::uint32_t>(model_.meshes.size()));
    if (is_new) {
        Mesh mesh;
        mesh.name = fmt::format("object '{}', material '{}'", model_.objects[entry->first.first],
                                model_.materials[material_].name);
        mesh.material = material_;
        mesh.back_emits = false;
        model_.meshes.push_back(std::move(mesh));
        model_.instances.push_back({entry->second, file_to_world(options_), entry->first.first});
    }
    return entry->second;
}

std::uint32_t ObjReader::object() {
    const std::string name = object_.empty() || group_.empty() ? object_ + group_ : object_ + '.' + group_;
    const auto [entry, is_new] = object_index_.try_emplace(name, static_cast<std::uint32_t>(model_.objects.size()));
    if (is_new) model_.objects.push_back(name);
    return entry->second;
}

/// Reads material libraries. A single name may contain spaces and '#', or be followed by a comment.
void ObjReader::libraries(const LineReader& line, Words words, const Location& where) {
    const std::filesystem::path folder = model_.file.parent_path();
    std::error_code ignored;
    if (std::filesystem::exists(folder / line.rest(), ignored)) return materials_.read(folder / line.rest(), where);
    if (words.size() == 2) return materials_.read(folder / without_comment(line.rest()), where);
    for (const std::string_view name : words.subspan(1)) materials_.read(folder / name, where);
}

}  // namespace interflect::detail
