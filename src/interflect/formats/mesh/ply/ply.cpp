#include "interflect/formats/mesh/ply/ply.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <utility>

#include "interflect/core.h"
#include "interflect/formats/build/material_limits.h"
#include "interflect/formats/build/model.h"
#include "interflect/formats/build/scene_faces.h"
#include "interflect/formats/mesh/ply/header.h"
#include "interflect/formats/reading/checked_options.h"
#include "interflect/formats/reading/file_to_world.h"
#include "interflect/formats/reading/location.h"
#include "interflect/formats/text/text_file.h"
#include "interflect/image/codecs/srgb.h"

namespace interflect::detail {

namespace fs = std::filesystem;

namespace {

class PlyReader {
  public:
    PlyReader(const PlyHeader& header, PlyValues& values, Model& model, const ReadOptions& options)
        : header_(header), values_(values), model_(model), mesh_(model.meshes.emplace_back()), options_(options) {
        mesh_.name = "the mesh";
    }

    void read() {
        if (header_.has_unknown_lines)
            model_.warnings.add("unsupported-entity", "lines of the header that begin with no word of PLY are left out",
                                model_.file.string());
        has_line_each_ = has_line_for_each_element();
        for (const PlyElement& element : header_.elements) {
            if (element.count > 0 && !values_.may_hold(1, 1)) throw std::invalid_argument(too_short(element));
            if (!element.properties.empty() &&
                (element.count > max_elements ||
                 !values_.may_hold(element.count * element.fewest_values(), element.count * element.fewest_bytes())))
                throw std::invalid_argument(too_short(element));
            if (element.name == "vertex")
                read_vertices(element);
            else if (element.name == "face")
                read_faces(element);
            else if (element.name == "tristrips")
                read_strips(element);
            else
                skip(element);
        }
        if (!values_.is_at_end())
            model_.warnings.add("surplus-data", "data after the last element of the header is left out",
                                model_.file.string());
        for (const std::uint32_t index : mesh_.indices) require_vertex(index);
        model_.instances.push_back({0, file_to_world(options_), 0});
        model_.materials.push_back(material());
    }

  private:
    static constexpr std::uint64_t max_elements = std::uint64_t{1} << 40;  // keeps products below 2^64

    /// Returns whether a text has one element per line, so that surplus values can be skipped.
    bool has_line_for_each_element() const {
        const auto lines = values_.lines_left();
        std::uint64_t elements = 0;
        for (const PlyElement& element : header_.elements)
            if (!element.properties.empty()) elements += std::min(element.count, max_elements);
        return lines && *lines == elements;
    }

    void end_element() {
        if (has_line_each_ && values_.skip_line())
            model_.warnings.add("surplus-data",
                                "values that the header does not declare are left out at the ends of lines",
                                model_.file.string());
    }

    static std::string too_short(const PlyElement& element) {
        return fmt::format("the file is too short for {} of '{}'", element.count, element.name.substr(0, 40));
    }

    std::uint64_t list_length(const PlyProperty& property) {
        const double length = values_.next(*property.count_type);
        if (!(length >= 0 && length < none) || length != std::floor(length))
            throw std::invalid_argument(fmt::format("{} is no length of a list", length));
        const auto count = static_cast<std::uint64_t>(length);
        if (!values_.may_hold(count, count * size_of(property.type)))
            throw std::invalid_argument(fmt::format("the file ends within a list of {}", count));
        return count;
    }

    void skip(const PlyProperty& property) {
        for (std::uint64_t n = property.count_type ? list_length(property) : 1; n > 0; --n) values_.next(property.type);
    }

    void skip(const PlyElement& element) {
        for (std::uint64_t i = 0; i < element.count && !element.properties.empty(); ++i) {
            for (const PlyProperty& property : element.properties) skip(property);
            end_element();
        }
    }

    void read_vertices(const PlyElement& element) {
        if (!mesh_.positions.empty()) throw std::invalid_argument("there are two elements 'vertex'");
        if (element.count >= none) throw std::invalid_argument("more vertices than 32 bits can count");
        std::array<std::optional<std::size_t>, 3> place, tint, normal;  // indices of properties
        for (std::size_t c = 0; c < 3; ++c) {
            place[c] = element.find(std::array{"x", "y", "z"}[c]);
            tint[c] = element.find(std::array{"red", "green", "blue"}[c]);
            normal[c] = element.find(std::array{"nx", "ny", "nz"}[c]);
            if (!place[c]) throw std::invalid_argument("a vertex needs the properties x, y and z");
        }
        const bool has_colour = tint[0] && tint[1] && tint[2], has_normal = normal[0] && normal[1] && normal[2];
        mesh_.positions.reserve(element.count);
        std::vector<double> row(element.properties.size());
        for (std::uint64_t i = 0; i < element.count; ++i) {
            for (std::size_t p = 0; p < row.size(); ++p) {
                if (element.properties[p].count_type)
                    skip(element.properties[p]);
                else
                    row[p] = values_.next(element.properties[p].type);
            }
            end_element();
            const Imath::V3d x(row[*place[0]], row[*place[1]], row[*place[2]]);
            if (!std::isfinite(x.x + x.y + x.z)) throw std::invalid_argument(fmt::format("vertex {} is not finite", i));
            mesh_.positions.push_back(x);
            if (has_normal) mesh_.normals.emplace_back(row[*normal[0]], row[*normal[1]], row[*normal[2]]);
            if (has_colour) note_colour({row[*tint[0]], row[*tint[1]], row[*tint[2]]});
        }
        has_vertices_ = true;
        colours_are_bytes_ = has_colour && std::ranges::all_of(tint, [&](const std::optional<std::size_t>& channel) {
                                 return element.properties[*channel].type == PlyType::uint8;
                             });
    }

    /// Keeps the first colour, and notes whether another one differs.
    void note_colour(const RgbD& colour) {
        if (!colour_) colour_ = colour;
        colours_vary_ |= colour != *colour_;
    }

    void require_vertex(double index) const {
        if (!(index < static_cast<double>(mesh_.positions.size())))
            throw std::invalid_argument(
                fmt::format("a face has vertex {}, but there are {}", index, mesh_.positions.size()));
    }

    static std::size_t vertex_list(const PlyElement& element, const char* owner) {
        const auto named = element.find("vertex_indices");
        const auto list = named ? named : element.find("vertex_index");
        if (!list || !element.properties[*list].count_type)
            throw std::invalid_argument(fmt::format("{} needs the list vertex_indices", owner));
        return *list;
    }

    void require_room(std::uint64_t faces) const {
        if (faces > options_.max_patches)
            throw ReadFault(
                fmt::format("{} faces would give more than {} patches (max_patches)", faces, options_.max_patches),
                "max_patches");
    }

    void read_faces(const PlyElement& element) {
        const std::size_t list = vertex_list(element, "a face");
        require_room(element.count);
        for (std::uint64_t i = 0; i < element.count; ++i) {
            for (std::size_t p = 0; p < element.properties.size(); ++p) {
                if (p == list)
                    read_face(element.properties[p]);
                else
                    skip(element.properties[p]);
            }
            end_element();
        }
    }

    void read_face(const PlyProperty& property) {
        const std::uint64_t size = list_length(property);
        if (size < 3) {
            model_.warnings.add("degenerate-face", "faces with fewer than three vertices are left out",
                                model_.file.string());
            for (std::uint64_t i = 0; i < size; ++i) values_.next(property.type);
            return;
        }
        if (size > options_.max_face_vertices)
            throw std::invalid_argument(
                fmt::format("a face has {} vertices; expected 3 to {}", size, options_.max_face_vertices));
        mesh_.face_sizes.push_back(static_cast<std::uint32_t>(size));
        for (std::uint64_t i = 0; i < size; ++i) mesh_.indices.push_back(vertex_number(values_.next(property.type)));
    }

    std::uint32_t vertex_number(double index) const {
        if (!(index >= 0 && index < none) || index != std::floor(index))
            throw std::invalid_argument(fmt::format("{} is no number of a vertex", index));
        if (has_vertices_) require_vertex(index);
        return static_cast<std::uint32_t>(index);
    }

    void read_strips(const PlyElement& element) {
        const std::size_t list = vertex_list(element, "an element 'tristrips'");
        for (std::uint64_t i = 0; i < element.count; ++i) {
            for (std::size_t p = 0; p < element.properties.size(); ++p) {
                if (p == list)
                    read_strip(element.properties[p]);
                else
                    skip(element.properties[p]);
            }
            end_element();
        }
    }

    /// Reads a triangle strip. Each vertex after the first two adds a triangle, whose orientation alternates; -1 begins
    /// a new strip.
    void read_strip(const PlyProperty& property) {
        std::uint64_t length = 0;  // number of vertices in the current strip
        std::array<std::uint32_t, 2> last{};
        for (std::uint64_t left = list_length(property); left > 0; --left) {
            const double value = values_.next(property.type);
            if (value == -1) {
                length = 0;
                continue;
            }
            const std::uint32_t v = vertex_number(value);
            if (length >= 2 && last[0] != last[1] && last[1] != v && v != last[0]) {
                require_room(mesh_.face_sizes.size() + 1);
                const std::size_t odd = length % 2;
                mesh_.indices.insert(mesh_.indices.end(), {last[odd], last[1 - odd], v});
                mesh_.face_sizes.push_back(3);
            }
            last = {last[1], v};
            ++length;
        }
    }

    Material material() {
        Material result = default_material();
        if (!colour_) return result;
        if (colours_vary_ || !colours_are_bytes_) {
            model_.warnings.add("vertex-colours",
                                "colours of vertices are left out: all faces are of a reflectance of 0.5",
                                model_.file.string());
            return result;
        }
        for (int c = 0; c < 3; ++c) result.reflectance[c] = srgb_decode(static_cast<float>((*colour_)[c] / 255));
        limit_reflectance(result.reflectance);
        return result;
    }

    const PlyHeader& header_;
    PlyValues& values_;
    Model& model_;
    Mesh& mesh_;
    const ReadOptions& options_;
    std::optional<RgbD> colour_;  // colour of the first vertex
    bool colours_vary_ = false, colours_are_bytes_ = false, has_vertices_ = false;
    bool has_line_each_ = false;  // whether a text has one element per line
};

}  // namespace

Scene read_ply(const fs::path& path, const ReadOptions& options) {
    return read_ply_bytes(read_bytes(path), path, options);
}

Scene read_ply_bytes(std::string_view bytes, const fs::path& path, const ReadOptions& options) {
    checked(options);
    Model model;
    model.file = path;
    model.files.push_back(path.string());
    std::int64_t line = 0;
    try {
        const PlyHeader header = parse_ply_header(bytes, line);
        PlyValues values(bytes.substr(header.size), header.form);
        const std::int64_t last_of_header = std::exchange(line, 0);  // binary data has no lines
        try {
            PlyReader(header, values, model, options).read();
        } catch (const std::invalid_argument&) {
            if (const auto lines = values.lines()) line = last_of_header + 1 + *lines;
            throw;
        }
    } catch (const std::invalid_argument& fault) {
        throw Location{&path, line}.error(fault);
    }
    return scene_of(std::move(model), options);
}

}  // namespace interflect::detail
