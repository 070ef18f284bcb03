// `light`, an extension of MGF: see docs/mgf-extensions.md.
#include <fmt/format.h>

#include <functional>
#include <string>
#include <unordered_map>

#include "interflect/formats/mgf_reader.h"

namespace interflect::inline detail {

using Imath::V3d;

/// The normal of a vertex, in the world, as the direction in which a light shines.
V3f MgfReader::direction_of(std::string_view vertex) {
    V3d direction;
    total_transform().multDirMatrix(normal_of(vertex), direction);
    return V3f(direction.normalized());
}

void MgfReader::light(MgfWords words) {
    struct Kind {
        std::size_t arguments;
        const char* usage;
    };
    static const std::unordered_map<std::string_view, Kind> kinds = {
        {"point", {3, "light point vertex intensity"}},
        {"spot", {5, "light spot vertex intensity inner-angle outer-angle"}},
        {"directional", {3, "light directional vertex irradiance"}},
        {"sky", {2, "light sky radiance"}}};
    const auto kind = kinds.find(words[0]);
    if (kind == kinds.end())
        throw MgfFault(fmt::format("there is no light '{}'; expected point, spot, directional or sky", words[0]));
    if (words.size() != kind->second.arguments)
        throw MgfFault(fmt::format("expected '{}', found {} argument{}", kind->second.usage, words.size(),
                                   words.size() == 1 ? "" : "s"));
    faults_.refuse(colours_.current().fault);
    const double luminance = non_negative_argument(words[0] == "sky" ? words[1] : words[2]);
    const Rgb colour = scene_.emitted(colours_.current(), luminance, here());
    const auto position = [&] { return scene_.position(vertices_.find(words[1]).point * total_transform()); };
    const auto angle = [&](std::size_t i) { return static_cast<float>(number_argument(words[i])); };
    Luminaire luminaire{"", objects_.current(), UniformSky{colour}};
    if (words[0] == "point") luminaire.kind = PointLight{position(), colour};
    if (words[0] == "spot") luminaire.kind = SpotLight{position(), direction_of(words[1]), colour, angle(3), angle(4)};
    if (words[0] == "directional") luminaire.kind = DirectionalLight{direction_of(words[1]), colour};
    scene_.add_light(std::move(luminaire));
}

}  // namespace interflect::inline detail
