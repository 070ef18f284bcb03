#include "interflect/exports/records/luminaire_records.h"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string_view>

#include "interflect/exports/records/solve_report.h"
#include "interflect/scene/sky/model_parameters.h"

namespace interflect::detail {

namespace {

constexpr std::array<const char*, 3> shape_names{"box", "cylinder", "ellipsoid"};

Json record_of(const PointLight& light) {
    return {{"position", json_of(light.position)}, {"intensity", json_of(light.intensity)}};
}

Json record_of(const SpotLight& light) {
    return {{"position", json_of(light.position)},
            {"direction", json_of(light.direction)},
            {"intensity", json_of(light.intensity)},
            {"inner_angle", shortest_number(light.inner_angle)},
            {"outer_angle", shortest_number(light.outer_angle)}};
}

Json record_of(const DirectionalLight& light) {
    Json json{{"direction", json_of(light.direction)}, {"irradiance", json_of(light.irradiance)}};
    if (light.diameter > 0) json["diameter"] = shortest_number(light.diameter);
    return json;
}

Json record_of(const UniformSky& sky) { return {{"radiance", json_of(sky.radiance)}}; }

Json record_of(const MeasuredLight& light) {
    return {{"position", json_of(light.position)},
            {"direction", json_of(light.direction)},
            {"c0", json_of(light.c0)},
            {"mirrored", light.mirrored},
            {"factor", json_of(light.factor)}};
}

Json list_of(const std::vector<float>& numbers) {
    Json json = Json::array();
    for (const float x : numbers) json.push_back(shortest_number(x));
    return json;
}

Json record_of(const SkyDome& sky) {
    Json model = Json::array();
    for (const auto parameter : model_parameters) model.push_back(shortest_number(sky.model.*parameter));
    return {{"model", model},
            {"irradiance", json_of(sky.irradiance)},
            {"zenith", json_of(sky.zenith)},
            {"sun", json_of(sky.sun)},
            {"ground", shortest_number(sky.ground)}};
}

Json record_of(const EnvironmentMap& map) {
    return {{"zenith", json_of(map.zenith)}, {"north", json_of(map.north)}, {"factor", json_of(map.factor)}};
}

Json record_of(const PhotometricWeb& web) {
    const LuminousOpening& opening = web.opening;
    return {{"name", web.name},
            {"pole", web.pole == PhotometricWeb::Pole::c90 ? "c90" : "nadir"},
            {"polar", list_of(web.polar)},
            {"azimuth", list_of(web.azimuth)},
            {"intensities", list_of(web.intensities)},
            {"opening",
             {{"shape", shape_names[static_cast<std::size_t>(opening.shape)]},
              {"size", json_of(opening.size)},
              {"axis", opening.axis}}},
            {"lamp_lumens", web.lamp_lumens}};
}

template <class Vector>
Vector vector_at(const Json& json, const char* name) {
    return vector_of<Vector>(json.at(name));
}

SkyDome sky_of(const Json& json) {
    SkyDome sky;
    for (std::size_t i = 0; i < model_parameters.size(); ++i)
        sky.model.*model_parameters[i] = json.at("model").at(i).get<float>();
    sky.irradiance = vector_at<Rgb>(json, "irradiance");
    sky.zenith = vector_at<V3f>(json, "zenith");
    sky.sun = vector_at<V3f>(json, "sun");
    sky.ground = json.at("ground").get<float>();
    return sky;
}

PhotometricWeb web_of(const Json& json) {
    PhotometricWeb web;
    web.name = json.at("name").get<std::string>();
    if (json.at("pole") == "c90") web.pole = PhotometricWeb::Pole::c90;
    web.polar = json.at("polar").get<std::vector<float>>();
    web.azimuth = json.at("azimuth").get<std::vector<float>>();
    web.intensities = json.at("intensities").get<std::vector<float>>();
    const Json& opening = json.at("opening");
    const auto shape = opening.at("shape").get<std::string>();
    const auto found = std::find(shape_names.begin(), shape_names.end(), shape);
    if (found == shape_names.end()) throw std::runtime_error("unknown shape of a luminous opening: '" + shape + "'");
    web.opening = {static_cast<LuminousOpening::Shape>(found - shape_names.begin()), vector_at<V3f>(opening, "size"),
                   opening.at("axis").get<int>()};
    web.lamp_lumens = json.at("lamp_lumens").get<double>();
    return web;
}

}  // namespace

std::size_t WebTable::index_of(const std::shared_ptr<const PhotometricWeb>& web) {
    const auto [entry, is_new] = index_.try_emplace(web.get(), webs_.size());
    if (is_new) webs_.push_back(web);
    return entry->second;
}

Json WebTable::json() const {
    Json json = Json::array();
    for (const auto& web : webs_) json.push_back(record_of(*web));
    return json;
}

std::vector<std::shared_ptr<const PhotometricWeb>> webs_of(const Json& json) {
    std::vector<std::shared_ptr<const PhotometricWeb>> webs;
    for (const Json& web : json) webs.push_back(std::make_shared<PhotometricWeb>(web_of(web)));
    return webs;
}

Json json_of(const Luminaire& luminaire, WebTable& webs, const MapImages& maps) {
    Json json{{"name", luminaire.name}, {"object", luminaire.object}, {"kind", kind_name(luminaire)}};
    json.update(std::visit([](const auto& light) { return record_of(light); }, luminaire.kind));
    if (const auto* light = std::get_if<MeasuredLight>(&luminaire.kind)) json["web"] = webs.index_of(light->web);
    if (const auto* map = std::get_if<EnvironmentMap>(&luminaire.kind))
        json["map"] = std::find(maps.begin(), maps.end(), map->image) - maps.begin();
    return json;
}

Luminaire luminaire_of(const Json& json, const std::vector<std::shared_ptr<const PhotometricWeb>>& webs,
                       const MapImages& maps) {
    Luminaire luminaire{json.at("name").get<std::string>(), json.at("object").get<std::uint32_t>(), {}};
    const auto kind = json.at("kind").get<std::string>();
    if (kind == "point")
        luminaire.kind = PointLight{vector_at<V3f>(json, "position"), vector_at<Rgb>(json, "intensity")};
    else if (kind == "spot")
        luminaire.kind = SpotLight{vector_at<V3f>(json, "position"), vector_at<V3f>(json, "direction"),
                                   vector_at<Rgb>(json, "intensity"), json.at("inner_angle").get<float>(),
                                   json.at("outer_angle").get<float>()};
    else if (kind == "directional")
        luminaire.kind = DirectionalLight{vector_at<V3f>(json, "direction"), vector_at<Rgb>(json, "irradiance"),
                                          json.value("diameter", 0.0f)};
    else if (kind == "sky")
        luminaire.kind = UniformSky{vector_at<Rgb>(json, "radiance")};
    else if (kind == "sky-dome")
        luminaire.kind = sky_of(json);
    else if (kind == "environment")
        luminaire.kind = EnvironmentMap{maps.at(json.at("map").get<std::size_t>()), vector_at<V3f>(json, "zenith"),
                                        vector_at<V3f>(json, "north"), vector_at<Rgb>(json, "factor")};
    else if (kind == "measured")
        luminaire.kind = MeasuredLight{webs.at(json.at("web").get<std::size_t>()),
                                       vector_at<V3f>(json, "position"),
                                       vector_at<V3f>(json, "direction"),
                                       vector_at<V3f>(json, "c0"),
                                       json.at("mirrored").get<bool>(),
                                       vector_at<Rgb>(json, "factor")};
    else
        throw std::runtime_error("unknown kind of light: '" + kind + "'");
    return luminaire;
}

}  // namespace interflect::detail
