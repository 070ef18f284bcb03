#include "interflect/exports/records/texture_records.h"

#include <memory>
#include <string>

#include "interflect/scene/sky/environment_maps.h"

namespace interflect::detail {

namespace {

constexpr const char *reflectance_texture = "reflectance_texture", *exitance_texture = "exitance_texture",
                     *transmittance_texture = "transmittance_texture";
constexpr const char* coordinates_dataset = "/scene/texture_coordinates";
constexpr const char* lightmap_coordinates_dataset = "/scene/lightmap_coordinates";
constexpr const char* normals_dataset = "/scene/normals";

std::string texels_dataset(std::size_t texture) { return "/scene/textures/" + std::to_string(texture); }

std::string map_dataset(std::size_t map) { return "/scene/environment_maps/" + std::to_string(map); }

template <class Vector>
std::span<const float> numbers_of(const std::vector<Vector>& vectors) {
    return {reinterpret_cast<const float*>(vectors.data()), vectors.size() * sizeof(Vector) / sizeof(float)};
}

template <class Vector>
std::vector<Vector> read_vectors(const Hdf5Reader& file, const std::string& name) {
    constexpr std::size_t columns = sizeof(Vector) / sizeof(float);
    const std::vector<float> numbers = file.read<float>(name, columns);
    std::vector<Vector> vectors(numbers.size() / columns);
    for (std::size_t i = 0; i < numbers.size(); ++i) vectors[i / columns][static_cast<int>(i % columns)] = numbers[i];
    return vectors;
}

}  // namespace

Json json_of(const Texture& texture) {
    return {{"name", texture.name}, {"width", texture.width}, {"height", texture.height}};
}

Json json_of(const std::vector<Texture>& textures) {
    Json json = Json::array();
    for (const Texture& t : textures) json.push_back(json_of(t));
    return json;
}

std::vector<Texture> textures_of(const Json& json) {
    std::vector<Texture> textures;
    for (const Json& t : json)
        textures.push_back({t.at("name").get<std::string>(),
                            t.at("width").get<std::uint32_t>(),
                            t.at("height").get<std::uint32_t>(),
                            {}});
    return textures;
}

void add_textures(const Material& material, Json& json) {
    if (material.reflectance_texture != none) json[reflectance_texture] = material.reflectance_texture;
    if (material.exitance_texture != none) json[exitance_texture] = material.exitance_texture;
    if (material.transmittance_texture != none) json[transmittance_texture] = material.transmittance_texture;
}

void read_textures(const Json& json, Material& material) {
    material.reflectance_texture = json.value(reflectance_texture, none);
    material.exitance_texture = json.value(exitance_texture, none);
    material.transmittance_texture = json.value(transmittance_texture, none);
}

std::vector<FileRange> write_textures(Hdf5Writer& file, const Scene& scene) {
    std::vector<FileRange> ranges;
    for (std::size_t i = 0; i < scene.textures.size(); ++i)
        ranges.push_back(
            file.write(texels_dataset(i), numbers_of(scene.textures[i].texels), sizeof(Rgb) / sizeof(float)));
    const auto maps = environment_maps(scene);
    for (std::size_t i = 0; i < maps.size(); ++i)
        ranges.push_back(file.write(map_dataset(i), numbers_of(maps[i]->texels), sizeof(Rgb) / sizeof(float)));
    const auto write_coordinates = [&](const char* dataset, const std::vector<V2f>& coordinates) {
        if (!coordinates.empty())
            ranges.push_back(file.write(dataset, numbers_of(coordinates), sizeof(V2f) / sizeof(float)));
    };
    write_coordinates(coordinates_dataset, scene.texture_coordinates);
    write_coordinates(lightmap_coordinates_dataset, scene.lightmap_coordinates);
    if (!scene.normals.empty())
        ranges.push_back(file.write(normals_dataset, numbers_of(scene.normals), sizeof(V3f) / sizeof(float)));
    return ranges;
}

void read_textures(const Hdf5Reader& file, Scene& scene) {
    for (std::size_t i = 0; i < scene.textures.size(); ++i)
        scene.textures[i].texels = read_vectors<Rgb>(file, texels_dataset(i));
    const auto maps = environment_maps(scene);
    for (std::size_t i = 0; i < maps.size(); ++i) {
        auto image = std::make_shared<Texture>(*maps[i]);
        image->texels = read_vectors<Rgb>(file, map_dataset(i));
        for (Luminaire& luminaire : scene.luminaires)
            if (auto* map = std::get_if<EnvironmentMap>(&luminaire.kind); map && map->image == maps[i])
                map->image = image;
    }
    if (file.has(coordinates_dataset)) scene.texture_coordinates = read_vectors<V2f>(file, coordinates_dataset);
    if (file.has(lightmap_coordinates_dataset))
        scene.lightmap_coordinates = read_vectors<V2f>(file, lightmap_coordinates_dataset);
    if (file.has(normals_dataset)) scene.normals = read_vectors<V3f>(file, normals_dataset);
}

}  // namespace interflect::detail
