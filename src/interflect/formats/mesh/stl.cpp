#include "interflect/formats/mesh/stl.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "interflect/core.h"
#include "interflect/formats/build/material_limits.h"
#include "interflect/formats/build/model.h"
#include "interflect/formats/build/scene_faces.h"
#include "interflect/formats/reading/byte_order.h"
#include "interflect/formats/reading/checked_options.h"
#include "interflect/formats/reading/file_to_world.h"
#include "interflect/formats/reading/location.h"
#include "interflect/formats/text/extension.h"
#include "interflect/formats/text/line_reader.h"
#include "interflect/formats/text/number.h"
#include "interflect/formats/text/text_file.h"

namespace interflect::detail {

namespace fs = std::filesystem;
using Imath::V3d;

namespace {

constexpr std::string_view byte_order_mark = "\xef\xbb\xbf";
constexpr std::size_t stl_header = 80, stl_triangle = 50;  // [bytes]

/// Returns whether the file is text that begins with `solid` in any case, after blanks and a byte order mark.
bool is_ascii_stl(std::string_view bytes) {
    constexpr std::string_view blanks = " \t\r\n", keyword = "solid";
    constexpr std::size_t sample = 1 << 10;  // [bytes]; binary coordinates contain zero bytes
    if (bytes.starts_with(byte_order_mark)) bytes.remove_prefix(byte_order_mark.size());
    bytes.remove_prefix(std::min(bytes.find_first_not_of(blanks), bytes.size()));
    return lower_case(bytes.substr(0, keyword.size())) == keyword && bytes.substr(0, sample).find('\0') == bytes.npos;
}

/// Returns the number of triangles in the header of a binary file, or nullopt if the file is shorter.
/// A count of 0, which streaming exporters leave, stands for all triangles in the file.
std::optional<std::size_t> binary_triangles(std::string_view bytes) {
    if (bytes.size() < stl_header + 4) return std::nullopt;
    const std::size_t count = number_of<std::uint32_t>(bytes.substr(stl_header), std::endian::little);
    const std::size_t available = (bytes.size() - stl_header - 4) / stl_triangle;
    if (count > available) return std::nullopt;
    return count > 0 ? count : available;
}

Mesh& add_solid(Model& model, const std::string& name, const ReadOptions& options) {
    const auto index = static_cast<std::uint32_t>(model.meshes.size());
    Mesh& mesh = model.meshes.emplace_back();
    mesh.name = "solid '" + name + "'";
    if (!name.empty()) model.objects.push_back(name);
    model.instances.push_back(
        {index, file_to_world(options), name.empty() ? 0 : static_cast<std::uint32_t>(model.objects.size() - 1)});
    return mesh;
}

void add_vertex(Mesh& mesh, const V3d& x) {
    mesh.indices.push_back(static_cast<std::uint32_t>(mesh.positions.size()));
    mesh.positions.push_back(x);
}

void read_binary_stl(std::string_view bytes, std::size_t count, Model& model, const ReadOptions& options) {
    Mesh& mesh = add_solid(model, "", options);
    if (bytes.size() > stl_header + 4 + count * stl_triangle)
        model.warnings.add("surplus-data", "data after the last triangle that the header counts is left out",
                           model.file.string());
    mesh.positions.reserve(3 * count);
    mesh.indices.reserve(3 * count);
    for (std::size_t triangle = 0; triangle < count; ++triangle) {
        // A record consists of a normal, three vertices and two bytes of attributes.
        const std::string_view record = bytes.substr(stl_header + 4 + triangle * stl_triangle, stl_triangle);
        for (std::size_t v = 1; v <= 3; ++v) {
            V3d x;
            for (std::size_t axis = 0; axis < 3; ++axis) {
                x[static_cast<int>(axis)] = number_of<float>(record.substr(4 * (3 * v + axis)), std::endian::little);
                if (!std::isfinite(x[static_cast<int>(axis)]))
                    throw InputError(model.file, 0,
                                     fmt::format("a coordinate of triangle {} is not finite", triangle + 1));
            }
            add_vertex(mesh, x);
        }
    }
}

/// Reads the triangles of a text. Ignores normals.
void read_ascii_stl(std::string_view text, Model& model, const ReadOptions& options) {
    Mesh* solid = nullptr;
    std::size_t vertices = 0;
    for (LineReader lines(text); lines.next();) {
        const auto words = lines.words();
        const auto fail = [&](const std::string& fault) { throw InputError(model.file, lines.line(), fault); };
        const std::string keyword = lower_case(words[0].substr(0, options.max_name_length));
        if (keyword == "solid") {
            solid = &add_solid(model, std::string(lines.rest().substr(0, options.max_name_length)), options);
        } else if (keyword == "vertex") {
            if (!solid) fail("a vertex before the first 'solid'");
            if (words.size() != 4) fail(fmt::format("a vertex has {} coordinates, not 3", words.size() - 1));
            if (vertices % 3 == 0 && vertices / 3 >= options.max_patches / 2)
                throw Location{&model.file, lines.line()}.error(
                    fmt::format("this would give more than {} patches (max_patches)", options.max_patches),
                    "max_patches");
            V3d x;
            for (int axis = 0; axis < 3; ++axis) {
                const auto value = parse_number(words[axis + 1]);
                if (!value) fail(fmt::format("expected a finite number, not '{}'", words[axis + 1]));
                x[axis] = *value;
            }
            add_vertex(*solid, x);
            ++vertices;
        } else if (keyword == "facet" || keyword == "endloop") {
            if (vertices % 3 != 0) fail("a facet must have three vertices");
        } else if (keyword != "outer" && keyword != "endfacet" && keyword != "endsolid") {
            fail(fmt::format("'{}' is no word of an STL file", words[0].substr(0, 20)));
        }
    }
    if (vertices % 3 != 0) throw InputError(model.file, 0, "the file ends within a facet");
}

}  // namespace

Scene read_stl(const fs::path& path, const ReadOptions& options) {
    return read_stl_bytes(read_bytes(path), path, options);
}

Scene read_stl_bytes(std::string_view bytes, const fs::path& path, const ReadOptions& options) {
    checked(options);
    Model model;
    model.file = path;
    model.files.push_back(path.string());
    model.materials.push_back(default_material());
    const bool is_ascii = is_ascii_stl(bytes);
    if (const auto count = is_ascii ? std::nullopt : binary_triangles(bytes)) {
        if (*count > options.max_patches / 2)
            throw Location{&path}.error(
                fmt::format("{} triangles would give more than {} patches (max_patches)", *count, options.max_patches),
                "max_patches");
        read_binary_stl(bytes, *count, model, options);
    } else {
        if (!is_ascii)
            throw InputError(
                path, 0, "this is no STL file: expected 'solid', or 84 bytes and 50 for each triangle that it counts");
        if (bytes.starts_with(byte_order_mark)) bytes.remove_prefix(byte_order_mark.size());
        require_text(bytes, path);
        read_ascii_stl(bytes, model, options);
    }
    return scene_of(std::move(model), options);
}

}  // namespace interflect::detail
