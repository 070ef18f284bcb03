#include "interflect/formats/mgf/write_mgf.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ostream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "interflect/base/files/pending_file.h"
#include "interflect/formats/build/colour.h"
#include "interflect/formats/build/texture_files.h"
#include "interflect/scene/core/web_angles.h"
#include "interflect/scene/sky/environment_maps.h"
#include "interflect/scene/sky/sky_frame.h"

namespace interflect::detail {

namespace {

constexpr std::size_t buffer_size = 1 << 16;  // [characters]

std::string printable(std::string_view name) {
    std::string text(name);
    for (char& c : text)
        if (static_cast<unsigned char>(c) <= ' ' || c == '\x7f' || c == '\\') c = '_';
    return text;
}

/// Returns a name that MGF accepts: '-' separates the loops of a face, and '=' defines names.
std::string material_name(const Material& material) {
    std::string name = printable(material.name);
    if (name.starts_with('-') || name == "=") name[0] = '_';
    return name;
}

std::vector<std::string> object_path(const std::string& dotted_name) {
    std::vector<std::string> path;
    if (dotted_name.empty()) return path;
    const std::string name = printable(dotted_name);
    for (std::size_t begin = 0;;) {
        const std::size_t dot = name.find('.', begin);
        path.push_back(dot == begin || begin == name.size() ? "_" : name.substr(begin, dot - begin));
        if (dot == std::string::npos) return path;
        begin = dot + 1;
    }
}

/// Angles of rotations about x, then y, then z [degrees].
struct Turns {
    double x, y, z;
};

/// Axes of a right-handed orthonormal frame.
struct Frame {
    Imath::V3d x, y, z;
};

/// Returns the frame with x in the C0 plane and -z at the nadir.
Frame frame_of(const MeasuredLight& light) {
    const Imath::V3d z(-light.direction.normalized()), c0(light.c0), x = (c0 - z * z.dot(c0)).normalized();
    return {x, z.cross(x), z};
}

/// Returns the frame with x to the east and y to the north.
Frame frame_of(const SkyFrame& sky) { return {Imath::V3d(sky.east), Imath::V3d(sky.north), Imath::V3d(sky.zenith)}; }

/// Returns the rotations that turn the axes into the frame.
Turns turns_of(const Frame& frame) {
    const auto& [x, y, z] = frame;
    constexpr double no_turn = 1e-9;  // cosine below which x and z turn about the same axis (gimbal lock)
    const double cosine = std::hypot(x.x, x.y);
    if (cosine < no_turn) return {degrees(std::atan2(-z.y, y.y)), degrees(std::atan2(-x.z, cosine)), 0};
    return {degrees(std::atan2(y.z, z.z)), degrees(std::atan2(-x.z, cosine)), degrees(std::atan2(x.y, x.x))};
}

class MgfWriter {
  public:
    MgfWriter(const Scene& scene, std::ostream& out, std::span<const std::string> textures,
              std::span<const std::string> webs, std::span<const std::string> maps)
        : scene_(scene), out_(out), textures_(textures), vertex_written_(scene.vertices.size(), false) {
        const auto all = photometric_webs(scene);
        for (std::size_t i = 0; i < all.size(); ++i) web_files_.emplace(all[i].get(), webs[i]);
        const auto images = environment_maps(scene);
        for (std::size_t i = 0; i < images.size(); ++i) map_files_.emplace(images[i].get(), maps[i]);
        for (const Material& material : scene.materials) names_.push_back(material_name(material));
    }

    void write() {
        put("# {} patches\n", scene_.patches.size());
        for (std::size_t i = 0; i < scene_.patches.size(); ++i) {
            const Patch& patch = scene_.patches[i];
            const bool two_sided = patch.other_side == i + 1;
            enter_object(patch.object);
            enter_material(patch.material, two_sided ? two_sides : 1);
            add_face(patch);
            if (two_sided) ++i;
        }
        for (const Luminaire& luminaire : scene_.luminaires) add_light(luminaire);
        leave_objects(0);
        flush();
    }

  private:
    static constexpr int two_sides = 2;  // default of new materials

    struct Definition {
        std::uint32_t material = none;
        int sides = two_sides;
    };

    template <class... Values>
    void put(fmt::format_string<Values...> format, Values&&... values) {
        fmt::format_to(std::back_inserter(buffer_), format, std::forward<Values>(values)...);
        if (buffer_.size() > buffer_size) flush();
    }

    void flush() {
        out_.write(buffer_.data(), static_cast<std::streamsize>(buffer_.size()));
        buffer_.clear();
        if (!out_) throw std::runtime_error("the scene cannot be written: the disk may be full");
    }

    void enter_object(std::uint32_t object) {
        if (object == object_) return;
        object_ = object;
        const std::vector<std::string> path = object_path(scene_.objects[object]);
        const auto common = std::mismatch(path.begin(), path.end(), open_objects_.begin(), open_objects_.end()).first;
        const auto shared = static_cast<std::size_t>(common - path.begin());
        leave_objects(shared);
        for (std::size_t level = shared; level < path.size(); ++level) put("o {}\n", path[level]);
        open_objects_ = path;
    }

    void leave_objects(std::size_t depth) {
        for (; open_objects_.size() > depth; open_objects_.pop_back()) put("o\n");
    }

    /// Enters a material. Defines it again if its name was reused, or if it has no name and another one was entered
    /// since.
    void enter_material(std::uint32_t material, int sides) {
        const std::string& name = names_[material];
        Definition& definition = definitions_[name];
        const bool is_new = definition.material != material || (name.empty() && material_ != material);
        if (is_new) {
            put("m {}{}\n", name, name.empty() ? "" : " =");
            define_material(scene_.materials[material]);
            definition = {material, two_sides};
        } else if (material_ != material) {
            put("m {}\n", name);
        }
        if (definition.sides != sides) put("\tsides {}\n", sides);
        definition.sides = sides;
        material_ = material;
    }

    void define_material(const Material& material) {
        constexpr std::string_view smooth = " 0";  // roughness
        RgbD reflectance(material.reflectance);
        if (material.reflectance_texture == none)  // with a texture, readers limit the product
            for (int c = 0; c < 3; ++c) reflectance[c] = std::min(reflectance[c], largest_reflectance);
        put_colour("rd", reflectance);
        if (channel_sum(material.specular_reflectance) > 0)
            put_colour("rs", RgbD(material.specular_reflectance), smooth);
        if (channel_sum(material.transmittance) > 0) put_colour("ts", RgbD(material.transmittance), smooth);
        if (channel_sum(material.exitance) > 0) put_colour("ed", RgbD(material.exitance));
        put_texture("rd", material.reflectance_texture);
        put_texture("ts", material.transmittance_texture);
        put_texture("ed", material.exitance_texture);
    }

    void put_texture(std::string_view entity, std::uint32_t texture) {
        if (texture != none) put("\ttexture {} {}\n", entity, textures_[texture]);
    }

    void put_colour(std::string_view entity, const RgbD& rgb, std::string_view rest = "") {
        const auto [chromaticity, luminance] = from_rec709(rgb);
        put("\tc\n\t\tcxy {} {}\n\t{} {}{}\n", chromaticity.x, chromaticity.y, entity, luminance, rest);
    }

    void add_face(const Patch& patch) {
        for (int k = 0; k < patch.vertex_count(); ++k) {
            const std::uint32_t v = patch.vertices[k];
            if (vertex_written_[v]) continue;
            const V3f& x = scene_.vertices[v];
            if (scene_.origin == Imath::V3d(0)) {
                put("v v{} =\n\tp {} {} {}\n", v, x.x, x.y, x.z);
            } else {
                const Imath::V3d world = scene_.origin + Imath::V3d(x);
                put("v v{} =\n\tp {} {} {}\n", v, world.x, world.y, world.z);
            }
            if (!scene_.texture_coordinates.empty())
                put("\tuv {} {}\n", scene_.texture_coordinates[v].x, scene_.texture_coordinates[v].y);
            if (!scene_.normals.empty() && scene_.normals[v] != V3f(0))
                put("\tn {} {} {}\n", scene_.normals[v].x, scene_.normals[v].y, scene_.normals[v].z);
            vertex_written_[v] = true;
        }
        put("f");
        for (int k = 0; k < patch.vertex_count(); ++k) put(" v{}", patch.vertices[k]);
        put("\n");
    }

    void add_light(const Luminaire& luminaire) {
        enter_object(luminaire.object);
        const auto* measured = std::get_if<MeasuredLight>(&luminaire.kind);
        const auto* map = std::get_if<EnvironmentMap>(&luminaire.kind);
        const Rgb factor = measured ? measured->factor : map ? map->factor : rating(luminaire);
        const auto [chromaticity, luminance] = from_rec709(RgbD(factor));
        if (measured) return add_measured(*measured, chromaticity, luminance);
        put("c\n\tcxy {} {}\n", chromaticity.x, chromaticity.y);
        if (const auto* point = std::get_if<PointLight>(&luminaire.kind)) {
            add_light_vertex(point->position, V3f(0, 0, 1));
            put("light point {} {}\n", light_vertex, luminance);
        } else if (const auto* spot = std::get_if<SpotLight>(&luminaire.kind)) {
            add_light_vertex(spot->position, spot->direction);
            put("light spot {} {} {} {}\n", light_vertex, luminance, spot->inner_angle, spot->outer_angle);
        } else if (const auto* directional = std::get_if<DirectionalLight>(&luminaire.kind)) {
            add_light_vertex(V3f(0), directional->direction);
            put("light directional {} {} {}\n", light_vertex, luminance, directional->diameter);
        } else if (const auto* dome = std::get_if<SkyDome>(&luminaire.kind)) {
            add_dome(*dome, luminance);
        } else if (map) {
            add_turned(frame_of(SkyFrame(map->zenith, map->north)), [&, radiance = luminance] {
                put("light environment {} 0 {}\n", map_files_.at(map->image.get()), radiance);
            });
        } else {
            put("light sky {}\n", luminance);
        }
    }

    void add_dome(const SkyDome& dome, double illuminance) {
        const Frame frame = frame_of(SkyFrame(dome.zenith));
        const Imath::V3d sunlight(-dome.sun);
        add_turned(frame, [&] {
            const SkyModel& m = dome.model;
            put("v {} =\n\tn {} {} {}\n", light_vertex, sunlight.dot(frame.x), sunlight.dot(frame.y),
                sunlight.dot(frame.z));
            put("light sky model {} {} {} {} {} {} {} {} {}\n", light_vertex, illuminance, dome.ground, m.a, m.b, m.c,
                m.d, m.e, m.g);
        });
    }

    /// Writes a light inside a transform that rotates the axes to the frame.
    template <class Put>
    void add_turned(const Frame& frame, const Put& put_light) {
        const Turns turns = turns_of(frame);
        const bool is_turned = turns.x != 0 || turns.y != 0 || turns.z != 0;
        if (is_turned) put("xf -rx {} -ry {} -rz {}\n", turns.x, turns.y, turns.z);
        put_light();
        if (is_turned) put("xf\n");
    }

    /// Writes `ies`, which refers to the colour by name.
    void add_measured(const MeasuredLight& light, const Chromaticity& chromaticity, double multiplier) {
        const Turns turns = turns_of(frame_of(light));
        const Imath::V3d world = scene_.origin + Imath::V3d(light.position);
        put("c {} =\n\tcxy {} {}\nies {} -m {} -c {}", light_vertex, chromaticity.x, chromaticity.y,
            web_files_.at(light.web.get()), multiplier, light_vertex);
        if (light.mirrored) put(" -my");
        put(" -rx {} -ry {} -rz {} -t {} {} {}\n", turns.x, turns.y, turns.z, world.x, world.y, world.z);
    }

    void add_light_vertex(const V3f& position, const V3f& normal) {
        const Imath::V3d world = scene_.origin + Imath::V3d(position);
        put("v {} =\n\tp {} {} {}\n\tn {} {} {}\n", light_vertex, world.x, world.y, world.z, normal.x, normal.y,
            normal.z);
    }

    static constexpr const char* light_vertex = "light";

    const Scene& scene_;
    std::ostream& out_;
    std::span<const std::string> textures_;                    // file names
    std::vector<std::string> names_;                           // names of materials
    std::unordered_map<std::string, Definition> definitions_;  // keys: names of materials
    std::unordered_map<const PhotometricWeb*, std::string> web_files_;
    std::unordered_map<const Texture*, std::string> map_files_;
    std::vector<bool> vertex_written_;
    std::vector<std::string> open_objects_;
    std::uint32_t object_ = 0, material_ = none;
    fmt::memory_buffer buffer_;
};

}  // namespace

void write_mgf(const Scene& scene, std::ostream& out, std::span<const std::string> textures,
               std::span<const std::string> webs, std::span<const std::string> maps) {
    const auto require_names = [](std::size_t names, std::size_t count, const char* what) {
        if (names != count)
            throw std::runtime_error(
                fmt::format("the scene has {} {}, and there are names for {} files", count, what, names));
    };
    require_names(textures.size(), scene.textures.size(), "textures");
    require_names(webs.size(), photometric_webs(scene).size(), "photometric webs");
    require_names(maps.size(), environment_maps(scene).size(), "environment maps");
    MgfWriter(scene, out, textures, webs, maps).write();
}

void write_mgf(const Scene& scene, const std::filesystem::path& path, std::span<const std::string> textures,
               std::span<const std::string> webs, std::span<const std::string> maps) {
    std::ostringstream text;
    write_mgf(scene, text, textures, webs, maps);
    write_file(path, std::move(text).str());
}

std::vector<std::shared_ptr<const PhotometricWeb>> photometric_webs(const Scene& scene) {
    std::vector<std::shared_ptr<const PhotometricWeb>> webs;
    std::unordered_set<const PhotometricWeb*> known;
    for (const Luminaire& luminaire : scene.luminaires)
        if (const auto* light = std::get_if<MeasuredLight>(&luminaire.kind))
            if (known.insert(light->web.get()).second) webs.push_back(light->web);
    return webs;
}

std::vector<std::string> web_files(const Scene& scene, const std::filesystem::path& path) {
    std::vector<std::string> files;
    for (std::size_t i = 0; i < photometric_webs(scene).size(); ++i)
        files.push_back(printable(fmt::format("{}.web-{}.ies", path.stem().string(), i)));
    return files;
}

std::vector<std::string> map_files(const Scene& scene, const std::filesystem::path& path) {
    std::vector<std::string> files;
    for (std::size_t i = 0; i < environment_maps(scene).size(); ++i)
        files.push_back(printable(fmt::format("{}.map-{}.exr", path.stem().string(), i)));
    return files;
}

std::vector<std::string> texture_files(const Scene& scene, const std::filesystem::path& path) {
    std::vector<std::string> files;
    for (const Texture& texture : scene.textures)
        files.push_back(
            printable(fmt::format("{}.texture-{}{}", path.stem().string(), files.size(), texture_extension(texture))));
    return files;
}

}  // namespace interflect::detail
