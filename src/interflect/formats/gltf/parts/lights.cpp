#include "interflect/formats/gltf/parts/lights.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "interflect/core.h"
#include "interflect/formats/photometry/ies.h"
#include "interflect/formats/text/foreign_text.h"
#include "interflect/scene/core/view.h"

namespace interflect::detail {

namespace {

using Imath::V3d;

constexpr const char* punctual_lights = "KHR_lights_punctual";
constexpr const char* measured_lights = "EXT_lights_ies";

constexpr std::size_t max_lights = 1 << 16;

constexpr double degrees_per_radian = 180 / std::numbers::pi;

/// Returns the direction of a node's axis in the world. Lights and cameras face along -z.
V3d axis_of(const GltfNode& node, int axis) {
    const double* row = node.to_world[axis];
    const V3d direction(row[0], row[1], row[2]);
    if (!(direction.length() > 0)) node.value->fail("its scale of 0 leaves no direction for its light or camera");
    return direction.normalized();
}

std::string unique_name(std::set<std::string>& taken, const std::string& name) {
    std::string result = name;
    for (int i = 2; !taken.insert(result).second; ++i) result = fmt::format("{}-{}", name, i);
    return result;
}

SpotLight spot_of(const GltfValue& light) {
    constexpr double quarter_turn = std::numbers::pi / 2;
    const GltfValue spot = light.object("spot");
    const double inner = spot.amount("innerConeAngle", 0), outer = spot.amount("outerConeAngle", quarter_turn / 2);
    if (!(inner <= outer) || outer > quarter_turn + 1e-6)
        spot.fail(fmt::format("its cone goes from {} to {}, expected 0 <= inner <= outer <= pi / 2", inner, outer));
    SpotLight result;
    result.inner_angle = static_cast<float>(inner * degrees_per_radian);
    result.outer_angle = static_cast<float>(outer * degrees_per_radian);
    return result;
}

}  // namespace

GltfLights::GltfLights(GltfAsset& asset, GltfBuffers& buffers)
    : asset_(asset),
      buffers_(buffers),
      punctual_(asset.root().extension(punctual_lights).objects("lights")),
      profiles_(asset.root().extension(measured_lights).objects("lights")),
      cameras_(asset.root().objects("cameras")) {}

bool GltfLights::has_light(const GltfNode& node) const {
    return node.value->extension(punctual_lights).exists() || node.value->extension(measured_lights).exists();
}

void GltfLights::add(const GltfNode& node, std::uint32_t object) {
    if (node.value->extension(punctual_lights).exists()) add_punctual(node, object);
    if (node.value->extension(measured_lights).exists()) add_measured(node, object);
    if (node.value->has("camera")) add_view(node);
}

void GltfLights::add_light(Luminaire luminaire, const GltfNode& node, const std::string& name) {
    if (asset_.model.lights.size() >= max_lights)
        node.value->fail(fmt::format("this is one light more than the {} that are read", max_lights));
    luminaire.name = unique_name(light_names_, !node.name.empty() ? node.name : name.empty() ? "light" : name);
    if (const std::string fault = luminaire_fault(luminaire); !fault.empty()) node.value->fail("its light " + fault);
    asset_.model.lights.push_back({std::move(luminaire), node.to_world.translation()});
}

void GltfLights::add_punctual(const GltfNode& node, std::uint32_t object) {
    const GltfValue use = node.value->extension(punctual_lights);
    const GltfValue& light = punctual_[use.required_index("light", punctual_.size())];
    const Rgb strength = light.colour("color", Rgb(1)) * static_cast<float>(light.amount("intensity", 1));
    if (light.has("range")) asset_.warn("light-range", "the range of lights is ignored", light.place());
    Luminaire luminaire;
    luminaire.object = object;
    const std::string type = light.text("type");
    if (type == "point") {
        luminaire.kind = PointLight{.intensity = strength};
    } else if (type == "spot") {
        SpotLight spot = spot_of(light);
        spot.direction = V3f(-axis_of(node, 2));
        spot.intensity = strength;
        luminaire.kind = spot;
    } else if (type == "directional") {
        luminaire.kind = DirectionalLight{.direction = V3f(-axis_of(node, 2)), .irradiance = strength};
    } else {
        light.fail("its type is not point, spot or directional");
    }
    add_light(std::move(luminaire), node, light.text("name"));
}

std::shared_ptr<const PhotometricWeb> GltfLights::web(std::uint32_t profile) {
    std::shared_ptr<const PhotometricWeb>& result = webs_[profile];
    if (result) return result;
    const GltfValue& owner = profiles_[profile];
    const bool has_uri = owner.has("uri");
    const std::string text =
        has_uri ? asset_.read_uri(owner.text("uri"), owner)
                : std::string(buffers_.view(owner.required_index("bufferView", buffers_.view_count())).bytes);
    if (text.size() > asset_.options().max_photometric_bytes)
        owner.fail(fmt::format("it has {} bytes, more than {} (max_photometric_bytes)", text.size(),
                               asset_.options().max_photometric_bytes));
    const std::filesystem::path name = asset_.path().string() + ": " + owner.place();
    const bool is_foreign = has_uri && !owner.text("uri").starts_with("data:");
    Warnings warnings;
    try {
        result = std::make_shared<PhotometricWeb>(
            read_enclosed_ies(text, name, asset_.path().parent_path(), asset_.options(), warnings));
    } catch (const InputError& fault) {
        if (!is_foreign) throw;
        throw InputError(
            Fault{.text = without_quotes(fault.what(), name.string().size()), .setting = fault.fault().setting});
    }
    for (const Warnings::Entry& w : warnings.entries())
        asset_.model.warnings.add(w.kind, is_foreign ? without_quotes(w.message) : w.message, w.where);
    return result;
}

/// Adds a measured luminaire, whose nadir is along -z, C0 along x and C90 along y.
void GltfLights::add_measured(const GltfNode& node, std::uint32_t object) {
    const GltfValue use = node.value->extension(measured_lights);
    const std::uint32_t profile = use.required_index("light", profiles_.size());
    MeasuredLight light;
    light.web = web(profile);
    light.direction = V3f(-axis_of(node, 2));
    light.c0 = V3f(axis_of(node, 0));
    light.mirrored = node.to_world.determinant() < 0;
    light.factor = use.colour("color", Rgb(1)) * static_cast<float>(use.amount("multiplier", 1));
    add_light({"", object, std::move(light)}, node, profiles_[profile].text("name"));
}

void GltfLights::add_view(const GltfNode& node) {
    const GltfValue& camera = cameras_[node.value->index("camera", cameras_.size())];
    View view;
    const std::string name = !node.name.empty() ? node.name : camera.text("name", "camera");
    view.name = unique_name(view_names_, name);
    view.eye = node.to_world.translation();
    view.look_at = view.eye - axis_of(node, 2);
    view.up = V3f(axis_of(node, 1));
    const std::string type = camera.text("type");
    if (type == "perspective")
        view.fov = static_cast<float>(camera.object("perspective").number("yfov") * degrees_per_radian);
    else if (type == "orthographic")
        view.extent = static_cast<float>(2 * camera.object("orthographic").number("ymag"));
    else
        camera.fail("its type is neither perspective nor orthographic");
    if (const std::string fault = view_fault(view); !fault.empty())
        node.value->fail(fmt::format("its camera {}", fault));
    asset_.model.views.push_back(std::move(view));
}

}  // namespace interflect::detail
