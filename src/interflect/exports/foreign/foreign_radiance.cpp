// Radiance (Ward 1994) divides photometric values by 179 lm/W.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <span>

#include "interflect/exports/files/exported_parts.h"
#include "interflect/exports/foreign/foreign_scene.h"
#include "interflect/exports/mesh/opacity.h"

namespace interflect::detail {

namespace for_radiance {
namespace {

using Imath::V3d;

constexpr float pi = std::numbers::pi_v<float>;
constexpr float efficacy = 179;        // [lm/W]
constexpr float lamp_radius = 0.005f;  // radius of spheres that represent point lights [m]

/// Formats three numbers after their count.
std::string numbers(const V3f& v) { return "3 " + triple(v); }

/// Encodes a texture with an additional edge of repeated texels, so that Radiance interpolates across the border of the
/// image.
std::string tile_bytes(const Texture& texture) {
    const std::uint32_t width = texture.width + 2, height = texture.height + 2;
    Texture tile{"", width, height, {}};
    for (std::uint32_t y = 0; y < height; ++y)
        for (std::uint32_t x = 0; x < width; ++x) {
            const std::uint32_t row = (y + texture.height - 1) % texture.height;
            const std::uint32_t column = (x + texture.width - 1) % texture.width;
            tile.texels.push_back(texture.texels[std::size_t{row} * texture.width + column]);
        }
    return hdr_bytes(tile);
}

/// Image file of a material.
struct Tile {
    std::string file;
    std::uint32_t width = 0, height = 0;  // size without the additional edge
};

Tile add_tile(ForeignScene& scene, const std::string& name, const Texture& texture) {
    return {scene.add_file(name + ".hdr", tile_bytes(texture)), texture.width, texture.height};
}

/// Returns an expression of Radiance for a texture coordinate, which is an affine function of the position.
std::string affine(const std::array<V3f, 3>& corners, const std::array<float, 3>& values) {
    const V3d origin(corners[0]), a = V3d(corners[1]) - origin, b = V3d(corners[2]) - origin;
    const V3d normal = a.cross(b);
    const double along_a = values[1] - values[0], along_b = values[2] - values[0];
    const V3d gradient = (along_a * b.cross(normal) + along_b * normal.cross(a)) / normal.dot(normal);
    return fmt::format("({:.9g}+Px*({:.9g})+Py*({:.9g})+Pz*({:.9g}))", values[0] - gradient.dot(origin), gradient.x,
                       gradient.y, gradient.z);
}

/// Returns an expression of Radiance for a coordinate along a side of a picture of `size` pixels. In Radiance, the
/// centre of the first pixel is at 0. The centre of the last pixel is at the ratio of the sides or, along the shorter
/// side, at 1.
/// @param pixel  Expression for the position in pixels; 0 at the centre of the first pixel.
std::string picture_coordinate(const std::string& pixel, std::uint32_t size, std::uint32_t other_side) {
    const double last = std::max(1.0, static_cast<double>(size) / other_side);
    return fmt::format("{}*{:.9g}", pixel, last / (size - 1));
}

/// Returns the expressions of the column and row of a triangle's points in a tile.
std::string place_in(const Tile& tile, const std::array<V3f, 3>& corners, const std::array<V2f, 3>& coordinates) {
    const auto along = [&](int k, std::uint32_t size, std::uint32_t other_side) {
        const std::string place = affine(corners, {coordinates[0][k], coordinates[1][k], coordinates[2][k]});
        return picture_coordinate(fmt::format("(.5+{}*frac{})", size, place), size + 2, other_side + 2);
    };
    return along(0, tile.width, tile.height) + " " + along(1, tile.height, tile.width);
}

/// Describes the surface of a mesh. Radiance has no texture coordinates at vertices, so each textured triangle has its
/// own mapping.
class Surface {
  public:
    Surface(ForeignScene& scene, const ForeignMesh& mesh) : scene_(scene), mesh_(mesh) {
        const Material& m = scene.material(mesh);
        const std::string& name = scene.materials[mesh.material];
        const auto& textures = scene.scene.textures;
        colour_ = scene.emits(mesh) ? scene.radiance(mesh) / efficacy : m.reflectance;
        if (scene.emits(mesh)) {
            if (m.reflectance != Rgb(0)) scene.leave_out("what emitting surfaces reflect");
            if (scene.is_cut_out(mesh)) scene.leave_out("holes of emitting surfaces");
            if (m.exitance_texture != none)
                pattern_ = add_tile(scene, name + "-exitance", textures[m.exitance_texture]);
        } else if (scene.is_cut_out(mesh)) {
            const Texture opacity = opacity_of(scene.scene, m);
            opacity_ = add_tile(scene, name + "-opacity", opacity);
            if (m.reflectance_texture != none)
                pattern_ = add_tile(scene, name + "-reflectance", opaque_reflectance(scene.scene, m, opacity));
        } else if (m.reflectance_texture != none) {
            pattern_ = add_tile(scene, name + "-reflectance", textures[m.reflectance_texture]);
        }
    }

    std::string text() const {
        if (pattern_ || opacity_) return text_of_triangles();
        std::string text = material_text("void", mesh_.name);
        for (std::size_t face = 0; face < mesh_.faces.size(); ++face) {
            std::vector<V3f> corners;
            for (const std::uint32_t v : mesh_.faces[face])
                if (v != none) corners.push_back(mesh_.positions[v]);
            text += polygon(mesh_.name, fmt::format("{}.{}", mesh_.name, face), corners);
        }
        return text;
    }

  private:
    static std::string polygon(const std::string& modifier, const std::string& name, std::span<const V3f> corners) {
        std::string text = fmt::format("{} polygon {}\n0\n0\n{}", modifier, name, 3 * corners.size());
        for (const V3f& corner : corners) text += "\n  " + triple(corner);
        return text + "\n";
    }

    /// Describes the material. The backs of one-sided faces transmit light; the backs of emitting faces are black.
    std::string material_text(const std::string& pattern, const std::string& name) const {
        if (scene_.emits(mesh_)) return fmt::format("{} light {}\n0\n0\n{}\n", pattern, name, numbers(colour_));
        const bool has_backs = mesh_.backs != Backs::pass;
        const std::string front = has_backs ? name : name + ".front";
        std::string text = fmt::format("{} plastic {}\n0\n0\n5 {} 0 0\n", pattern, front, triple(colour_));
        if (!has_backs) text += fmt::format("void mixfunc {} 4 {} void if(Rdot,1,0) .\n0\n0\n", name, front);
        return text;
    }

    std::string text_of_triangles() const {
        std::string text;
        std::size_t number = 0;
        for (const std::array<std::uint32_t, 3>& triangle : mesh_.triangles()) {
            const std::string name = fmt::format("{}.{}", mesh_.name, number++);
            std::array<V3f, 3> corners;
            std::array<V2f, 3> coordinates;
            for (std::size_t k = 0; k < 3; ++k) {
                corners[k] = mesh_.positions[triangle[k]];
                coordinates[k] = mesh_.texture_coordinates[triangle[k]];
            }
            std::string pattern = "void", material = name + ".surface";
            if (pattern_) {
                pattern = name + ".image";
                text += fmt::format("void colorpict {} 7 red green blue \"{}\" . {}\n0\n0\n", pattern, pattern_->file,
                                    place_in(*pattern_, corners, coordinates));
            }
            text += material_text(pattern, material);
            if (opacity_) {
                text += fmt::format("void mixpict {0}.holes 7 {0}.surface void grey \"{1}\" . {2}\n0\n0\n", name,
                                    opacity_->file, place_in(*opacity_, corners, coordinates));
                material = name + ".holes";
            }
            text += polygon(material, name, corners);
        }
        return text;
    }

    ForeignScene& scene_;
    const ForeignMesh& mesh_;
    Rgb colour_;  // reflectance, or the radiance of emitters in Radiance's unit
    std::optional<Tile> pattern_, opacity_;
};

std::string mesh_text(ForeignScene& scene, const ForeignMesh& mesh) {
    std::string text = Surface(scene, mesh).text();
    if (scene.emits(mesh) && mesh.backs == Backs::emit)
        text += Surface(scene, mesh.shifted_backs(scene.distance_of_backs())).text();
    return text;
}

std::string luminaire_text(ForeignScene& scene, const Luminaire& luminaire, const std::string& name) {
    const float disc = pi * lamp_radius * lamp_radius;  // [m^2]
    if (const auto* point = std::get_if<PointLight>(&luminaire.kind))
        return fmt::format("void illum {0}\n1 void\n0\n{1}\n{0} sphere {0}.lamp\n0\n0\n4 {2} {3}\n", name,
                           numbers(point->intensity / disc / efficacy), triple(point->position), lamp_radius);
    if (const auto* spot = std::get_if<SpotLight>(&luminaire.kind)) {
        if (spot->inner_angle < spot->outer_angle)
            scene.leave_out("how spots fade: they are even up to the outer angle");
        return fmt::format("void spotlight {0}\n0\n0\n7 {1} {2} {3}\n{0} sphere {0}.lamp\n0\n0\n4 {4} {5}\n", name,
                           triple(spot->intensity / disc / efficacy), 2 * spot->outer_angle,
                           triple(spot->direction.normalized()), triple(spot->position), lamp_radius);
    }
    if (const auto* directional = std::get_if<DirectionalLight>(&luminaire.kind)) {
        const float diameter = directional->diameter > 0 ? directional->diameter : 0.01f;  // [degrees]
        const float sine = std::sin(diameter / 360 * pi);
        return fmt::format("void light {0}\n0\n0\n{1}\n{0} source {0}.disc\n0\n0\n4 {2} {3}\n", name,
                           numbers(directional->irradiance / (pi * sine * sine) / efficacy),
                           triple(-directional->direction), diameter);
    }
    if (!is_sky(luminaire)) scene.leave_out(fmt::format("lights of the kind '{}'", kind_name(luminaire)));
    return "";
}

/// SkyModel in Radiance's language, as functions of the cosines of the angles to the zenith and to the sun.
constexpr const char* sky_functions =
    R"({ Luminance of a CIE general sky (CIE S 011:2003), or of Perez's, over a uniform ground.
  A1, A2, A3: zenith    A4, A5, A6: towards the sun    arg(7) to arg(12): a, b, c, d, e, g    arg(13): ground }
sky_zenith = A1*Dx + A2*Dy + A3*Dz;
sky_sun = bound(-1, A4*Dx + A5*Dy + A6*Dz, 1);
sky_gradation = 1 + arg(7)*Exp(arg(8)/bound(1e-3, sky_zenith, 1)) + arg(12)*sky_zenith;
sky_indicatrix = 1 + arg(9)*(Exp(arg(10)*acos(sky_sun)) - Exp(arg(10)*PI/2)) + arg(11)*sky_sun*sky_sun;
sky_luminance = if(sky_zenith, bound(0, sky_gradation, 1e10)*bound(0, sky_indicatrix, 1e10), arg(13));
)";

/// Describes the sky. Radiance has one source in each direction, so several skies or a map become an image. A single
/// sky model becomes a function.
std::string sky_text(ForeignScene& scene) {
    if (!scene.has_sky()) return "";
    std::vector<const Luminaire*> skies;
    for (const Luminaire& luminaire : scene.scene.luminaires)
        if (is_sky(luminaire)) skies.push_back(&luminaire);
    std::string pattern = "void";
    Rgb radiance(1);
    std::string text = "\n";
    if (const auto* sky = std::get_if<UniformSky>(&skies.front()->kind); sky && skies.size() == 1) {
        radiance = sky->radiance;
    } else if (const auto* dome = std::get_if<SkyDome>(&skies.front()->kind); dome && skies.size() == 1) {
        const V3f zenith = dome->zenith.normalized(), sun = dome->sun.normalized();
        const SkyModel& m = dome->model;
        const double integral = m.horizontal_integral(sun.dot(zenith));
        radiance = dome->irradiance / static_cast<float>(integral);
        pattern = "sky.luminance";
        text += fmt::format("void brightfunc {} 2 sky_luminance \"{}\"\n0\n13 {}  {}\n  {} {} {} {} {} {}  {}\n",
                            pattern, scene.add_file("sky.cal", sky_functions), triple(zenith), triple(sun), m.a, m.b,
                            m.c, m.d, m.e, m.g, static_cast<double>(dome->ground) / std::numbers::pi * integral);
    } else {
        pattern = "sky.image";
        const Texture image = scene.sky_image(2, latitude_longitude_direction);
        const auto along = [](const char* share, std::uint32_t size, std::uint32_t other_side) {
            const std::string pixel = fmt::format("bound(0,{0}*({1})-.5,{0}-1)", size, share);
            return picture_coordinate(pixel, size, other_side);
        };
        text += fmt::format("void colorpict {} 7 red green blue \"{}\" . {} {}\n0\n0\n", pattern,
                            scene.add_file("sky.hdr", hdr_bytes(image)),
                            along(".5-Atan2(Dy,Dx)/(2*PI)", image.width, image.height),
                            along("1-Acos(Dz)/PI", image.height, image.width));
    }
    return text + fmt::format("{} glow sky.glow\n0\n0\n4 {} 0\nsky.glow source sky\n0\n0\n4 0 0 1 360\n", pattern,
                              triple(radiance / efficacy));
}

/// Describes a view. The options -vh and -vv are full angles, or sizes of orthographic views.
std::string view_text(const ForeignScene& scene, const View& view) {
    const float aspect = static_cast<float>(scene.options.width) / static_cast<float>(scene.options.height);
    const float tangent = std::tan(view.fov / 360 * pi);
    const float vertical = view.extent > 0 ? view.extent : view.fov;
    const float horizontal = view.extent > 0 ? aspect * view.extent : 360 / pi * std::atan(aspect * tangent);
    return fmt::format("rvu -vt{} -vp {} -vd {} -vu {} -vh {} -vv {}\n", view.extent > 0 ? 'l' : 'v',
                       triple(V3f(view.eye)), triple(V3f(view.look_at - view.eye)), triple(view.up), horizontal,
                       vertical);
}

}  // namespace
}  // namespace for_radiance

std::string radiance_description(ForeignScene& scene) {
    using namespace for_radiance;
    std::string text =
        fmt::format("# Interflect {}: lengths in metres, radiance in lm/(m2 sr) / {}\n", INTERFLECT_VERSION, efficacy);
    for (const ForeignMesh& mesh : scene.meshes) text += "\n" + mesh_text(scene, mesh);
    for (std::size_t i = 0; i < scene.scene.luminaires.size(); ++i)
        text += "\n" + luminaire_text(scene, scene.scene.luminaires[i], scene.luminaires[i]);
    text += sky_text(scene);
    for (std::size_t i = 0; i < scene.views.size(); ++i)
        scene.add_file(fmt::format("view-{}.vf", i), view_text(scene, scene.views[i]));
    scene.warn_of_materials(ForeignScene::Support::without_glass);
    return text;
}

}  // namespace interflect::detail
