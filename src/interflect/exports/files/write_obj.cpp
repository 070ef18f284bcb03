#include <fmt/format.h>

#include <algorithm>
#include <numbers>
#include <numeric>

#include "interflect/core.h"
#include "interflect/elements/forest.h"
#include "interflect/exports/files/exported_parts.h"
#include "interflect/exports/files/mesh_files.h"
#include "interflect/exports/mesh/opacity.h"
#include "interflect/exports/vertices/lit_polygons.h"
#include "interflect/geometry/textures/texture_mapping.h"
#include "interflect/image/codecs/image_codecs.h"
#include "interflect/image/codecs/srgb.h"

namespace interflect::detail {

namespace {

std::string text_of_colour(const Rgb& colour) { return fmt::format("{} {} {}", colour.x, colour.y, colour.z); }

/// Encodes opacity as PNG. Readers of MTL treat its greys as linear, so decoded values cancel the sRGB encoding of PNG.
std::string opacity_png(const Texture& opacity) {
    Image image(static_cast<int>(opacity.width), static_cast<int>(opacity.height));
    for (std::size_t i = 0; i < opacity.texels.size(); ++i) image.pixels[i] = Rgb(srgb_decode(opacity.texels[i].x));
    return codecs::encode_png(image);
}

std::string materials_text(const std::filesystem::path& path, const Scene& scene, std::vector<ExportedFile>& images) {
    const std::vector<std::string> names = material_names(scene);
    std::string text = fmt::format("# Interflect {}\n", INTERFLECT_VERSION);
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
        const Material& m = scene.materials[i];
        text += fmt::format("\nnewmtl {}\nillum 1\nKd {}\n", names[i], text_of_colour(m.reflectance));
        if (m.exitance != Rgb(0))
            text += fmt::format("Ke {}\n", text_of_colour(m.exitance / std::numbers::pi_v<float>));
        if (m.specular_reflectance != Rgb(0)) text += fmt::format("Ks {}\n", text_of_colour(m.specular_reflectance));
        const auto add = [&](const std::string& name, std::string bytes) {
            images.push_back({path_beside(path, fmt::format("{}-{}", names[i], name)), std::move(bytes)});
            return images.back().path.filename().string();
        };
        if (m.transmittance_texture != none) {
            const Texture opacity = opacity_of(scene, m);
            text += fmt::format("map_d {}\n", add("opacity.png", opacity_png(opacity)));
            text +=
                fmt::format("map_Kd {}\n", add("reflectance.exr", exr_bytes(opaque_reflectance(scene, m, opacity))));
        } else {
            if (m.transmittance != Rgb(0)) text += fmt::format("Tf {}\n", text_of_colour(m.transmittance));
            if (m.reflectance_texture != none)
                text += fmt::format("map_Kd {}\n", images[m.reflectance_texture].path.filename().string());
        }
        if (m.exitance_texture != none)
            text += fmt::format("map_Ke {}\n", images[m.exitance_texture].path.filename().string());
    }
    return text;
}

std::vector<std::uint32_t> by_object_and_material(const Scene& scene, const ElementForest& forest,
                                                  const LitPolygons& polygons) {
    std::vector<std::uint32_t> order(polygons.size());
    std::iota(order.begin(), order.end(), 0u);
    const auto key = [&](std::uint32_t i) {
        const Patch& patch = scene.patches[forest.patch(polygons.leaves[i])];
        return std::pair(patch.object, patch.material);
    };
    std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
    return order;
}

void append_vertices(std::string& text, const Scene& scene, const LitPolygons& polygons, float exposure) {
    for (const LitPolygons::Vertex& vertex : polygons.vertices) {
        const auto [r, g, b] = display_colour(vertex.radiosity, exposure);
        text += fmt::format("v {} {:.4g} {:.4g} {:.4g}\n", position_text(scene, polygons.points[vertex.point]),
                            r / 255.0, g / 255.0, b / 255.0);
    }
}

void append_faces(std::string& text, const Scene& scene, const ElementForest& forest, const LitPolygons& polygons) {
    const std::vector<std::string> materials = material_names(scene), objects = object_names(scene);
    std::uint32_t object = none, material = none, coordinates = 0;
    for (const std::uint32_t i : by_object_and_material(scene, forest, polygons)) {
        const Patch& patch = scene.patches[forest.patch(polygons.leaves[i])];
        if (patch.object != object) {
            text += fmt::format("o {}\n", objects[object = patch.object]);
            material = none;
        }
        if (patch.material != material) text += fmt::format("usemtl {}\n", materials[material = patch.material]);
        const bool is_textured = scene.materials[patch.material].is_textured();
        std::string face = "f";
        for (std::uint32_t c = polygons.begin(i); c < polygons.ends[i]; ++c) {
            face += fmt::format(" {}", polygons.corners[c] + 1);
            if (!is_textured) continue;
            const V2f uv = texture_coordinate(scene, patch, polygons.parameters[c]);
            text += fmt::format("vt {} {}\n", uv.x, uv.y);
            face += fmt::format("/{}", ++coordinates);
        }
        text += face + "\n";
    }
}

}  // namespace

std::vector<ExportedFile> make_obj(const std::filesystem::path& path, const Scene& scene, const Solution& solution,
                                   const ExportOptions& options) {
    require_nameable(path, "#\\");  // in OBJ, '#' begins a comment and '\' separates folders
    if (path.stem().string().starts_with(' '))
        throw InputError(
            path, 0,
            "files of this format cannot hold this name, whose first blanks readers skip: expected one without");
    VertexLight light = make_vertex_light(scene, solution, options);
    const LitPolygons polygons = options.polygons ? lit_polygons(scene, light) : lit_triangles(scene, light);
    std::vector<ExportedFile> files = texture_files(path, scene);
    const std::filesystem::path library = std::filesystem::path(path).replace_extension(".mtl");
    std::string text = fmt::format(
        "# Interflect {}\n# Colours of vertices: radiance [cd/m^2] * 2^{}, scaled to at most 1, as sRGB\nmtllib {}\n",
        INTERFLECT_VERSION, options.exposure, library.filename().string());
    append_vertices(text, scene, polygons, options.exposure);
    append_faces(text, scene, *light.forest, polygons);
    std::string materials = materials_text(path, scene, files);
    files.push_back({library, std::move(materials)});
    files.push_back({path, std::move(text)});
    return files;
}

}  // namespace interflect::detail
