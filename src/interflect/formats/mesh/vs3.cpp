#include "interflect/formats/mesh/vs3.h"

#include <fmt/format.h>

#include <ImathBox.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "interflect/core.h"
#include "interflect/formats/build/material_limits.h"
#include "interflect/formats/build/model.h"
#include "interflect/formats/reading/checked_options.h"
#include "interflect/formats/reading/file_to_world.h"
#include "interflect/formats/reading/location.h"
#include "interflect/formats/text/number.h"
#include "interflect/formats/text/text_file.h"

namespace interflect::detail {

namespace fs = std::filesystem;
using Imath::V3d;

namespace {

/// Words of a file, separated by blanks and commas; '!' begins a comment.
class Vs3Words {
  public:
    explicit Vs3Words(std::string_view text) : text_(text) {}

    /// Moves to the next line. @return  false at the end of the file.
    bool next_line() {
        if (is_started_) position_ = std::min(text_.find('\n', position_), text_.size() - 1) + 1;
        line_ += is_started_ || line_ == 0;
        is_started_ = true;
        return position_ < text_.size();
    }
    /// Returns the next word of this line, or an empty one at its end.
    std::string_view word() {
        while (position_ < text_.size() && is_separator(text_[position_])) ++position_;
        std::size_t end = position_;
        while (end < text_.size() && text_[end] != '\n' && text_[end] != '!' && !is_separator(text_[end])) ++end;
        const std::string_view result = text_.substr(position_, end - position_);
        position_ = end;
        return result;
    }
    /// Returns the next word of this or a later line, or an empty one at the end of the file.
    std::string_view word_of_any_line() {
        std::string_view result = word();
        while (result.empty() && next_line()) result = word();
        return result;
    }
    std::int64_t line() const { return line_; }  ///< Number of the line, from 1.

  private:
    static bool is_separator(char c) { return c == ' ' || c == ',' || c == '\t' || c == '\r'; }

    std::string_view text_;
    std::size_t position_ = 0;
    std::int64_t line_ = 0;
    bool is_started_ = false;
};

struct Vs3Surface {
    char type = 'S';  // S: radiating, M: mask, N: null surface, O: obstruction
    std::int64_t line = 0;
    std::vector<V3d> corners;
    int combined_with = 0;  // number of the surface with which this one is combined, or 0
    double emittance = 1;
    std::string name;
};

class Vs3Reader {
  public:
    Vs3Reader(std::string_view text, const fs::path& path, const ReadOptions& options)
        : words_(text), path_(path), options_(options) {}

    Scene read() {
        while (words_.next_line() && read_line()) {
        }
        if (surfaces_.empty()) throw InputError(path_, 0, "the file has no surface: expected lines that begin with S");
        return make_scene();
    }

  private:
    [[noreturn]] void fail(const std::string& fault) const { throw InputError(path_, words_.line(), fault); }

    /// Reads an entry. @return  false at the end of the data.
    bool read_line() {
        const std::string_view word = words_.word();
        if (word.empty()) return true;
        const char kind = upper(word.front());
        switch (kind) {
            case 'V':
                read_vertex();
                break;
            case 'S':
            case 'M':
            case 'N':
            case 'O':
                read_surface(kind);
                break;
            case 'F':
                read_format();
                break;
            case 'C':
                read_control();
                break;
            case 'E':
            case '*':
                return false;
            case 'T':  // title
            case 'X':  // coordinate transformation, which View3D ignores too
            case '/':  // comment
                break;
            default:
                fail(fmt::format("'{}' is no entry of a View3D file; expected T, C, F, V, S, M, N, O or E",
                                 word.substr(0, 20)));
        }
        return true;
    }

    static char upper(char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c; }

    double number(std::string_view word) const {
        const auto value = parse_number(word);
        if (!value) fail(fmt::format("expected a finite number, not '{}'", word.substr(0, 20)));
        return *value;
    }

    int integer() {
        const std::string_view word = words_.word();
        const auto value = parse_integer(word);
        if (!value) fail(fmt::format("expected an integer, not '{}'", word.substr(0, 20)));
        return *value;
    }

    void require_sequence(const char* what, std::size_t number) {
        if (const int found = integer(); std::cmp_not_equal(found, number))
            fail(fmt::format("{} {} is out of sequence; expected {}", what, found, number));
    }

    void read_format() {
        const std::string_view format = words_.word();
        if (format != "3" && format != "3a" && format != "3A")
            fail(fmt::format("the geometry is of format '{}'; expected 3 or 3a", format.substr(0, 20)));
        has_shapes_ = format != "3";
    }

    void read_control() {
        for (std::string_view word = words_.word(); !word.empty(); word = words_.word())
            if (word == "emit=1" || word == "EMIT=1")
                warnings_.add("view3d-emittances",
                              "the file asks for factors with reflection (emit=1); view factors do not include it",
                              fmt::format("{}:{}", path_.string(), words_.line()));
    }

    void read_vertex() {
        require_sequence("vertex", vertices_.size() + 1);
        V3d x;
        for (int axis = 0; axis < 3; ++axis) x[axis] = number(words_.word());
        vertices_.push_back(x);
    }

    void read_surface(char type) {
        Vs3Surface surface;
        surface.type = type;
        surface.line = words_.line();
        require_sequence("surface", surfaces_.size() + 1);
        if (surfaces_.size() >= options_.max_patches / 2)
            throw Location{&path_, words_.line()}.error(
                fmt::format("this would give more than {} patches (max_patches)", options_.max_patches), "max_patches");
        if (has_shapes_) {
            const std::string_view shape = words_.word();
            if (type != 'O') read_properties(surface);
            read_shape(shape.empty() ? ' ' : upper(shape.front()), surface);
        } else {
            read_corners(surface);
            if (type != 'O') read_properties(surface);
        }
        surfaces_.push_back(std::move(surface));
    }

    void read_corners(Vs3Surface& surface) {
        for (int corner = 0; corner < 4; ++corner) {
            const int v = integer();
            if (v == 0 && corner == 3) break;  // a triangle
            if (v < 1 || std::cmp_greater(v, vertices_.size()))
                fail(fmt::format("vertex {} does not exist; expected 1 to {}", v, vertices_.size()));
            surface.corners.push_back(vertices_[static_cast<std::size_t>(v - 1)]);
        }
    }

    /// Reads base, combination, emittance and name.
    void read_properties(Vs3Surface& surface) {
        const auto own = static_cast<int>(surfaces_.size()) + 1;
        const int base = integer();
        if (base < 0 || base == own) fail(fmt::format("the base of surface {} cannot be surface {}", own, base));
        if ((surface.type == 'M' || surface.type == 'N') && (base == 0 || base > own))
            fail(fmt::format("surface {} of type {} needs an earlier surface as its base, not {}", own, surface.type,
                             base));
        surface.combined_with = integer();
        if (surface.combined_with != 0) require_combination(surface, own);
        surface.emittance = number(words_.word());
        if (!(surface.emittance >= 0 && surface.emittance <= 1))
            fail(fmt::format("the emittance of surface {} is {:g}; expected 0 to 1", own, surface.emittance));
        surface.name = words_.word();
        if (surface.name.size() > options_.max_name_length) fail("the name of this surface is too long");
        if (surface.name.empty()) surface.name = fmt::format("{}", own);
    }

    void require_combination(const Vs3Surface& surface, int own) const {
        const int other = surface.combined_with;
        const auto is_radiating = [&](int number) {
            const Vs3Surface& s = surfaces_[static_cast<std::size_t>(number - 1)];
            return s.type == 'S' && s.combined_with == 0;
        };
        if (surface.type != 'S' || other < 1 || other >= own || !is_radiating(other))
            fail(fmt::format(
                "surface {} cannot be combined with {}; expected two surfaces of type S, the second earlier "
                "and not combined itself",
                own, other));
    }

    /// Reads an outline in a plane, which is given by its origin, its azimuth (clockwise from y) and its tilt (0 faces
    /// up, 90 is vertical) [degrees].
    void read_shape(char shape, Vs3Surface& surface) {
        if (shape != 'R' && shape != 'Q' && shape != 'T')
            fail("the shape is not R (rectangle), Q (quadrilateral) or T (triangle)");
        const auto next = [&] { return number(words_.word_of_any_line()); };
        V3d origin;
        for (int axis = 0; axis < 3; ++axis) origin[axis] = next();
        constexpr double radians = std::numbers::pi / 180;
        const double azimuth = next() * radians, tilt = next() * radians;
        const V3d x(-std::cos(azimuth), std::sin(azimuth), 0);
        const V3d y(-std::cos(tilt) * std::sin(azimuth), -std::cos(tilt) * std::cos(azimuth), std::sin(tilt));
        if (shape == 'R') {
            const double width = next(), height = next();
            surface.corners = {origin + height * y, origin, origin + width * x, origin + width * x + height * y};
            return;
        }
        for (int corner = 0; corner < (shape == 'T' ? 3 : 4); ++corner) {
            const double u = next(), v = next();
            surface.corners.push_back(origin + u * x + v * y);
        }
    }

    /// Distance of masks from their bases: four times the largest offset of rays (RayCaster::ray_offset), which is in
    /// proportion to coordinates, or to the scene if that is far from 0.
    double mask_distance() const {
        double largest = 0;
        Imath::Box3d bounds;
        for (const Vs3Surface& s : surfaces_)
            for (const V3d& x : s.corners) {
                bounds.extendBy(x);
                largest = std::max({largest, std::abs(x.x), std::abs(x.y), std::abs(x.z)});
            }
        constexpr double origin_limit = 16, relative = 0x1p-15;  // as origin_for()
        return relative * std::min(largest, origin_limit * bounds.size().length());
    }

    std::uint32_t material(double emittance, Model& model) {
        const auto [found, is_new] =
            material_of_emittance_.try_emplace(emittance, static_cast<std::uint32_t>(model.materials.size()));
        if (is_new) {
            Material m;
            m.name = fmt::format("emittance-{:g}", emittance);
            m.reflectance = Rgb(static_cast<float>(1 - emittance));
            limit_reflectance(m.reflectance);
            model.materials.push_back(m);
        }
        return found->second;
    }

    /// Returns the index of a new object. Surfaces may share a name, objects may not.
    std::uint32_t object(const Vs3Surface& surface, std::size_t number, Model& model) {
        const bool is_new = names_.insert(surface.name).second;
        model.objects.push_back(is_new ? surface.name : fmt::format("{}#{}", surface.name, number));
        return static_cast<std::uint32_t>(model.objects.size() - 1);
    }

    /// Removes the backs and makes the fronts one-sided.
    static void keep_fronts(Scene& scene) {
        PerPatch<Patch> fronts;
        for (std::size_t p = 0; p < scene.patches.size(); ++p)
            if (scene.patches[p].other_side > p) fronts.push_back(scene.patches[p]);
        for (Patch& patch : fronts) patch.other_side = no_patch;
        scene.patches = std::move(fronts);
    }

    Scene make_scene() {
        Model model;
        model.file = path_;
        model.files.push_back(path_.string());
        model.warnings = warnings_;
        model.materials.emplace_back();  // black: obstructions and null surfaces
        const double distance = mask_distance();
        std::vector<std::uint32_t> objects;  // object of each surface
        for (std::size_t i = 0; i < surfaces_.size(); ++i) {
            const Vs3Surface& surface = surfaces_[i];
            const bool radiates = surface.type == 'S' || surface.type == 'M';
            if (surface.combined_with != 0)
                objects.push_back(objects[static_cast<std::size_t>(surface.combined_with - 1)]);
            else
                objects.push_back(radiates ? object(surface, i + 1, model) : 0);
            Mesh& mesh = model.meshes.emplace_back();
            mesh.name = fmt::format("surface {} of line {}", i + 1, surface.line);
            mesh.positions = surface.corners;
            if (surface.type == 'N')  // a null surface faces its base, which its other side covers
                std::reverse(mesh.positions.begin(), mesh.positions.end());
            if (surface.type == 'M') {
                const V3d normal = (surface.corners[1] - surface.corners[0])
                                       .cross(surface.corners[2] - surface.corners[0])
                                       .normalized();
                for (V3d& x : mesh.positions)
                    x -= distance * normal;  // moves the surface away from its base, which it faces
            }
            for (std::uint32_t corner = 0; corner < mesh.positions.size(); ++corner) mesh.indices.push_back(corner);
            mesh.face_sizes = {static_cast<std::uint32_t>(mesh.positions.size())};
            mesh.material = radiates ? material(surface.emittance, model) : 0;
            model.instances.push_back({static_cast<std::uint32_t>(i), file_to_world(options_), objects.back()});
        }
        Scene scene = scene_of(std::move(model), options_);
        keep_fronts(scene);
        return scene;
    }

    Vs3Words words_;
    const fs::path& path_;
    const ReadOptions& options_;
    bool has_shapes_ = false;  // whether the file has shapes, as in format 3a
    std::vector<V3d> vertices_;
    std::vector<Vs3Surface> surfaces_;
    std::map<double, std::uint32_t> material_of_emittance_;
    std::set<std::string> names_;
    Warnings warnings_;
};

}  // namespace

Scene read_vs3(const fs::path& path, const ReadOptions& options) {
    return read_vs3_bytes(read_text_file(path), path, options);
}

Scene read_vs3_bytes(std::string_view bytes, const fs::path& path, const ReadOptions& options) {
    checked(options);
    require_text(bytes, path);
    return Vs3Reader(bytes, path, options).read();
}

}  // namespace interflect::detail
