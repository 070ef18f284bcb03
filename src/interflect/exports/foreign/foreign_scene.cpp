#include "interflect/exports/foreign/foreign_scene.h"

#include <ImathBox.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "interflect/base/threads/parallel.h"
#include "interflect/exports/files/exported_parts.h"
#include "interflect/exports/mesh/opacity.h"
#include "interflect/exports/vertices/lit_polygons.h"
#include "interflect/luminaires/skies/skies.h"
#include "interflect/prepare.h"

namespace interflect::detail {

namespace {

bool is_second_side(const Scene& scene, PatchIndex patch) { return scene.patches[patch].other_side < patch; }

Backs backs_of(const Scene& scene, const Patch& patch) {
    if (patch.other_side == none) return Backs::pass;
    return scene.materials[scene.patches[patch.other_side].material].exitance == Rgb(0) ? Backs::reflect : Backs::emit;
}

/// Groups faces by material and backs.
class Meshes {
  public:
    explicit Meshes(const Scene& scene) : scene_(scene), names_(material_names(scene)) {}

    void add(const Patch& patch) {
        constexpr std::array suffixes{"-one-sided", "", "-two-sided"};
        const Backs backs = backs_of(scene_, patch);
        const auto [entry, is_new] = numbers_.try_emplace({patch.material, backs}, meshes.size());
        if (is_new) {
            meshes.push_back({names_[patch.material] + suffixes[static_cast<std::size_t>(backs)],
                              patch.material,
                              backs,
                              {},
                              {},
                              {}});
            vertices_.emplace_back();
        }
        ForeignMesh& mesh = meshes[entry->second];
        std::array<std::uint32_t, 4> face{none, none, none, none};
        for (std::size_t k = 0; k < static_cast<std::size_t>(patch.vertex_count()); ++k)
            face[k] = vertex(patch.vertices[k], mesh, vertices_[entry->second]);
        mesh.faces.push_back(face);
    }

    std::vector<ForeignMesh> meshes;

  private:
    using Vertices = std::map<std::uint32_t, std::uint32_t>;

    std::uint32_t vertex(std::uint32_t v, ForeignMesh& mesh, Vertices& known) const {
        const auto [entry, is_new] = known.try_emplace(v, static_cast<std::uint32_t>(mesh.positions.size()));
        if (is_new) {
            mesh.positions.push_back(scene_.vertices[v]);
            if (scene_.materials[mesh.material].is_textured())
                mesh.texture_coordinates.push_back(scene_.texture_coordinates[v]);
        }
        return entry->second;
    }

    const Scene& scene_;
    const std::vector<std::string> names_;
    std::map<std::pair<std::uint32_t, Backs>, std::size_t> numbers_;
    std::vector<Vertices> vertices_;
};

std::vector<View> local_views(const Scene& scene, const std::vector<View>& chosen) {
    std::vector<View> views = chosen.empty() ? scene.views : chosen;
    if (views.empty()) views.push_back(overview(scene, RayCaster(scene)));
    for (View& view : views) {
        view.eye -= scene.origin;
        view.look_at -= scene.origin;
    }
    return views;
}

Texture scaled(Texture texture, const Rgb& factor) {
    for (Rgb& texel : texture.texels) texel *= factor;
    return texture;
}

}  // namespace

std::vector<std::array<std::uint32_t, 3>> ForeignMesh::triangles() const {
    std::vector<std::array<std::uint32_t, 3>> cut;
    for (const auto& [a, b, c, d] : faces) {
        cut.push_back({a, b, c});
        if (d != none) cut.push_back({a, c, d});
    }
    return cut;
}

ForeignMesh ForeignMesh::shifted_backs(float distance) const {
    ForeignMesh back{name + ".back", material, backs, {}, {}, {}};
    for (const auto& face : faces) {
        const std::size_t count = face[3] == none ? 3 : 4;
        const V3f& a = positions[face[0]];
        const V3f normal = (positions[face[1]] - a).cross(positions[face[count - 1]] - a).normalized();
        auto& reversed = back.faces.emplace_back(std::array<std::uint32_t, 4>{none, none, none, none});
        for (std::size_t k = 0; k < count; ++k) {
            const std::uint32_t v = face[count - 1 - k];
            reversed[k] = static_cast<std::uint32_t>(back.positions.size());
            back.positions.push_back(positions[v] - distance * normal);
            if (!texture_coordinates.empty()) back.texture_coordinates.push_back(texture_coordinates[v]);
        }
    }
    return back;
}

ForeignScene::ForeignScene(const Scene& exported, const std::filesystem::path& description,
                           const SceneExportOptions& chosen, std::string (*file_name_escape)(std::string_view))
    : scene(exported),
      path(description),
      options(chosen),
      escape(file_name_escape),
      materials(material_names(exported)),
      views(local_views(exported, chosen.views)) {
    std::vector<std::string> names;
    for (const Luminaire& luminaire : scene.luminaires) names.push_back(luminaire.name);
    luminaires = plain_names(names, "light");
    Meshes all(scene);
    for (PatchIndex i{0}; i < scene.patches.size(); ++i)
        if (!is_second_side(scene, i)) all.add(scene.patches[i]);
    meshes = std::move(all.meshes);
    Imath::Box3f bounds;
    for (const ForeignMesh& mesh : meshes)
        for (const V3f& position : mesh.positions) bounds.extendBy(position);
    if (bounds.isEmpty()) return;
    centre = bounds.center();
    size = (bounds.max - centre).length();
}

float ForeignScene::distance_of_backs() const {
    constexpr float relative = 1e-5f;  // about 100 times the rounding error of a coordinate
    float largest = 0;
    for (int k = 0; k < 3; ++k) largest = std::max(largest, std::abs(centre[k]) + size);
    return relative * largest;
}

std::string ForeignScene::add_file(const std::string& name, std::string bytes) {
    files.push_back({path_beside(path, name), std::move(bytes)});
    return escape(files.back().path.filename().string());
}

std::string ForeignScene::add_reflectance_image(std::uint32_t m) {
    const Material& material = scene.materials[m];
    return add_file(materials[m] + "-reflectance.exr",
                    exr_bytes(scaled(scene.textures[material.reflectance_texture], material.reflectance)));
}

std::string ForeignScene::add_radiance_image(std::uint32_t m) {
    const Material& material = scene.materials[m];
    return add_file(materials[m] + "-radiance.exr", exr_bytes(scaled(scene.textures[material.exitance_texture],
                                                                     material.exitance / std::numbers::pi_v<float>)));
}

std::string ForeignScene::add_transmittance_image(std::uint32_t m) {
    const Material& material = scene.materials[m];
    return add_file(materials[m] + "-transmittance.exr",
                    exr_bytes(scaled(scene.textures[material.transmittance_texture], material.transmittance)));
}

std::string ForeignScene::add_opacity_image(std::uint32_t m) {
    return add_file(materials[m] + "-opacity.exr", exr_bytes(opacity_of(scene, scene.materials[m])));
}

std::string ForeignScene::add_opaque_reflectance_image(std::uint32_t m) {
    const Material& material = scene.materials[m];
    const Texture reflectance = opaque_reflectance(scene, material, opacity_of(scene, material));
    return add_file(materials[m] + "-reflectance.exr", exr_bytes(scaled(reflectance, material.reflectance)));
}

bool ForeignScene::has_sky() const { return std::any_of(scene.luminaires.begin(), scene.luminaires.end(), is_sky); }

V3f latitude_longitude_direction(float x, float y) {
    constexpr float pi = std::numbers::pi_v<float>;
    const float azimuth = (0.5f - x) * 2 * pi, polar = pi * y;
    return {std::cos(azimuth) * std::sin(polar), std::sin(azimuth) * std::sin(polar), std::cos(polar)};
}

Texture ForeignScene::sky_image(int aspect, const std::function<V3f(float, float)>& direction) const {
    // Maps keep their resolution up to 2048 rows. Larger maps are averaged, which preserves the power of a sun in them.
    constexpr std::uint32_t least_rows = 512, most_rows = 2048, samples_per_row_of_map = 2;
    std::uint32_t rows = least_rows, samples = 1;
    for (const Luminaire& luminaire : scene.luminaires)
        if (const auto* map = std::get_if<EnvironmentMap>(&luminaire.kind)) {
            rows = std::max(rows, std::min(map->image->height, most_rows));
            samples = std::max(samples, samples_per_row_of_map * ((map->image->height + rows - 1) / rows));
        }
    const Skies skies(scene);
    const std::uint32_t columns = static_cast<std::uint32_t>(aspect) * rows;
    const auto sample_coordinate = [&](std::uint32_t i, std::uint32_t sample, std::uint32_t count) {
        return (static_cast<float>(i) + (static_cast<float>(sample) + 0.5f) / static_cast<float>(samples)) /
               static_cast<float>(count);
    };
    Texture image{"", columns, rows, std::vector<Rgb>(std::size_t{columns} * rows)};
    parallel_for_ranges(image.texels.size(), columns, [&](std::size_t begin, std::size_t end) {
        const auto y = static_cast<std::uint32_t>(begin / columns);
        for (std::size_t i = begin; i < end; ++i) {
            const auto x = static_cast<std::uint32_t>(i - begin);
            Rgb sum(0);
            for (std::uint32_t down = 0; down < samples; ++down)
                for (std::uint32_t across = 0; across < samples; ++across)
                    sum += skies.radiance(
                        direction(sample_coordinate(x, across, columns), sample_coordinate(y, down, rows)));
            image.texels[i] = sum / static_cast<float>(samples * samples);
        }
    });
    return image;
}

std::string ForeignScene::add_sky_image(int aspect, const std::function<V3f(float, float)>& direction) {
    return has_sky() ? add_file("sky.exr", exr_bytes(sky_image(aspect, direction))) : "";
}

Rgb ForeignScene::radiance(const ForeignMesh& mesh) const {
    return material(mesh).exitance / std::numbers::pi_v<float>;
}

void ForeignScene::warn_of_materials(Support support) {
    for (const ForeignMesh& mesh : meshes) {
        const Material& m = material(mesh);
        if (m.specular_reflectance != Rgb(0)) leave_out("mirrors");
        if (support == Support::all) continue;
        if (m.transmittance != Rgb(0) && !is_cut_out(mesh)) leave_out("glass: panes are opaque there");
        if (mesh.backs == Backs::pass && (emits(mesh) || support == Support::without_glass_and_backs))
            warnings.add("one-sided", "one-sided faces, through whose backs light passes here, block it there");
    }
}

Rgb mean_texel(const Texture& texture) {
    RgbD sum(0);
    for (const Rgb& texel : texture.texels) sum += RgbD(texel);
    return Rgb(sum / static_cast<double>(texture.texels.size()));
}

std::string ply_of(const ForeignMesh& mesh) {
    const auto triangles = mesh.triangles();
    const bool has_coordinates = !mesh.texture_coordinates.empty();
    std::string bytes = fmt::format(
        "ply\nformat binary_little_endian 1.0\nelement vertex {}\n"
        "property float x\nproperty float y\nproperty float z\n{}"
        "element face {}\nproperty list uchar int vertex_indices\nend_header\n",
        mesh.positions.size(), has_coordinates ? "property float u\nproperty float v\n" : "", triangles.size());
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        for (int k = 0; k < 3; ++k) append_bytes(bytes, mesh.positions[i][k]);
        if (!has_coordinates) continue;
        for (int k = 0; k < 2; ++k) append_bytes(bytes, mesh.texture_coordinates[i][k]);
    }
    for (const auto& triangle : triangles) {
        append_bytes(bytes, std::uint8_t{3});
        for (const std::uint32_t v : triangle) append_bytes(bytes, v);
    }
    return bytes;
}

std::string triple(const V3f& v, const char* between) {
    return fmt::format("{}{}{}{}{}", v.x, between, v.y, between, v.z);
}

}  // namespace interflect::detail
