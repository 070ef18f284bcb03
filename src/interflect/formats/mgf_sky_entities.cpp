// `light sky MODEL` and `light environment`, extensions of MGF: see docs/mgf-extensions.md.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "interflect/error.h"
#include "interflect/formats/mgf_reader.h"
#include "interflect/formats/sky_lights.h"
#include "interflect/scene/web_angles.h"

namespace interflect::inline detail {

using Imath::V3d;

namespace {

/// @param most  Arguments, the name of the model among them; the last may be left out.
void require_arguments(MgfWords words, std::size_t most, const char* usage) {
    if (words.size() == most || words.size() + 1 == most) return;
    throw MgfFault(
        fmt::format("expected 'light sky {} {}', found {} arguments after 'sky'", words[0], usage, words.size()));
}

}  // namespace

void MgfReader::sky(MgfWords words) {
    constexpr std::array<float SkyModel::*, 6> parameters = {&SkyModel::a, &SkyModel::b, &SkyModel::c,
                                                             &SkyModel::d, &SkyModel::e, &SkyModel::g};
    constexpr std::size_t without_sun = 3, with_sun = 4, of_perez = 5, of_model = 10;
    const auto lit = [&](std::string_view illuminance) {
        return scene_.emitted(colours_.current(), non_negative_argument(illuminance), here());
    };
    SkyDome dome;
    if (words[0] == "perez") {
        require_arguments(words, of_perez, "vertex direct-normal diffuse-horizontal [ground]");
        const V3f sunlight = direction_of(words[1]);
        const double altitude = degrees(std::asin(std::clamp(-sunlight.dot(turned({0, 0, 1})), -1.0f, 1.0f)));
        try {
            const PerezDaylight perez = perez_daylight(number_argument(words[2]), number_argument(words[3]), altitude);
            const auto light = [&](double lux) { return scene_.emitted(colours_.current(), lux, here()); };
            dome.model = perez.model, dome.sun = -sunlight, dome.irradiance = light(perez.sky_illuminance);
            add_sky(dome, words.subspan(4));
            scene_.add_light(
                {"", objects_.current(), DirectionalLight{sunlight, light(perez.sun_illuminance), sun_diameter}},
                "directional");
        } catch (const InputError& e) {
            throw MgfFault(e.what());
        }
        return;
    }
    if (words[0] == "model") {
        if (words.size() != of_model)
            throw MgfFault(
                fmt::format("expected 'light sky model vertex illuminance ground a b c d e g', found {} "
                            "arguments after 'sky'",
                            words.size()));
        for (std::size_t i = 0; i < parameters.size(); ++i)
            dome.model.*parameters[i] = static_cast<float>(number_argument(words[4 + i]));
        dome.sun = -direction_of(words[1]);
        dome.irradiance = lit(words[2]);
        return add_sky(dome, words.subspan(3, 1));
    }
    const int type = cie_sky_type(words[0]);
    if (type == 0)
        throw MgfFault(
            fmt::format("there is no sky '{}'; expected overcast, intermediate, clear, uniform, cie-1 to "
                        "cie-16, perez or model",
                        words[0]));
    dome.model = cie_standard_sky(type);
    if (!dome.model.depends_on_sun()) {
        require_arguments(words, without_sun, "illuminance [ground]");
        dome.sun = turned({0, 0, 1});
        dome.irradiance = lit(words[1]);
        return add_sky(dome, words.subspan(2));
    }
    require_arguments(words, with_sun, "vertex illuminance [ground]");
    dome.sun = -direction_of(words[1]);
    dome.irradiance = lit(words[2]);
    add_sky(dome, words.subspan(3));
}

/// @param ground  Its reflectance, or nothing: black.
void MgfReader::add_sky(SkyDome sky, MgfWords ground) {
    sky.zenith = turned({0, 0, 1});
    if (!ground.empty()) sky.ground = static_cast<float>(non_negative_argument(ground[0]));
    scene_.add_light({"", objects_.current(), sky}, "sky-dome");
}

void MgfReader::environment(MgfWords words) {
    EnvironmentMap map;
    const double rotation = words.size() > 1 ? radians(number_argument(words[1])) : 0;
    map.factor = scene_.emitted(colours_.current(), words.size() > 2 ? non_negative_argument(words[2]) : 1, here());
    map.zenith = turned({0, 0, 1});
    map.north = turned({std::sin(rotation), std::cos(rotation), 0});
    const std::filesystem::path path = file_->source.path.parent_path() / words[0];
    try {
        map.image = read_environment(path);
    } catch (const InputError& unreadable) {
        throw MgfFault(fmt::format("the environment map {}", unreadable.what()));
    }
    scene_.add_file(path);
    scene_.add_light({"", objects_.current(), std::move(map)}, "environment");
}

}  // namespace interflect::inline detail
