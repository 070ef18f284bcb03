#include "interflect/exports/luminaire_records.h"

#include <stdexcept>

#include "interflect/exports/solve_report.h"

namespace interflect::inline detail {

namespace {

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
    return {{"direction", json_of(light.direction)}, {"irradiance", json_of(light.irradiance)}};
}

Json record_of(const UniformSky& sky) { return {{"radiance", json_of(sky.radiance)}}; }

template <class Vector>
Vector vector_at(const Json& json, const char* name) {
    return vector_of<Vector>(json.at(name));
}

}  // namespace

Json json_of(const Luminaire& luminaire) {
    Json json{{"name", luminaire.name}, {"object", luminaire.object}, {"kind", kind_name(luminaire)}};
    json.update(std::visit([](const auto& light) { return record_of(light); }, luminaire.kind));
    return json;
}

Luminaire luminaire_of(const Json& json) {
    Luminaire luminaire{json.at("name").get<std::string>(), json.at("object").get<std::uint32_t>(), {}};
    const auto kind = json.at("kind").get<std::string>();
    if (kind == "point")
        luminaire.kind = PointLight{vector_at<V3f>(json, "position"), vector_at<Rgb>(json, "intensity")};
    else if (kind == "spot")
        luminaire.kind = SpotLight{vector_at<V3f>(json, "position"), vector_at<V3f>(json, "direction"),
                                   vector_at<Rgb>(json, "intensity"), json.at("inner_angle").get<float>(),
                                   json.at("outer_angle").get<float>()};
    else if (kind == "directional")
        luminaire.kind = DirectionalLight{vector_at<V3f>(json, "direction"), vector_at<Rgb>(json, "irradiance")};
    else if (kind == "sky")
        luminaire.kind = UniformSky{vector_at<Rgb>(json, "radiance")};
    else
        throw std::runtime_error("there is no light of the kind '" + kind + "'");
    return luminaire;
}

}  // namespace interflect::inline detail
