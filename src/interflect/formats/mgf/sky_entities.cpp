// The entities `light sky NAME` and `light environment` (docs/light/skies.md).
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "interflect/core.h"
#include "interflect/formats/build/texture_files.h"
#include "interflect/formats/mgf/reader.h"
#include "interflect/scene/core/web_angles.h"
#include "interflect/scene/sky/model_parameters.h"

namespace interflect::detail {

namespace {

void require_arguments(MgfWords words, std::size_t fewest, std::size_t most, const char* usage) {
    if (words.size() >= fewest && words.size() <= most) return;
    throw MgfFault(
        fmt::format("expected 'light sky {} {}', found {} arguments after 'sky'", words[0], usage, words.size()));
}

}  // namespace

void MgfReader::sky(MgfWords words) {
    if (words[0] == "perez") return perez_sky(words);
    SkyDome dome;
    dome.zenith = turned({0, 0, 1});
    dome.sun = dome.zenith;
    const auto read_illuminance = [&](std::string_view word) {
        dome.irradiance = scene_.emitted(colours_.current(), non_negative_argument(word), here());
    };
    const auto read_ground = [&](std::string_view word) {
        dome.ground = static_cast<float>(non_negative_argument(word));
    };
    if (words[0] == "model") {
        constexpr std::size_t all = 10, first_parameter = 4;
        require_arguments(words, all, all, "vertex illuminance ground a b c d e g");
        dome.sun = -direction_of(words[1]);
        read_illuminance(words[2]);
        read_ground(words[3]);
        for (std::size_t i = 0; i < model_parameters.size(); ++i)
            dome.model.*model_parameters[i] = static_cast<float>(number_argument(words[first_parameter + i]));
    } else {
        const int type = cie_sky_type(words[0]);
        if (type == 0)
            throw MgfFault(
                fmt::format("unknown sky '{}'; expected overcast, uniform, intermediate, clear, cie-1 to cie-16, "
                            "perez or model",
                            words[0]));
        dome.model = cie_standard_sky(type);
        const bool has_sun = dome.model.depends_on_sun();
        const std::size_t illuminance = has_sun ? 2 : 1, ground = illuminance + 1;
        require_arguments(words, ground, ground + 1, has_sun ? "vertex illuminance [ground]" : "illuminance [ground]");
        if (has_sun) dome.sun = -direction_of(words[1]);
        read_illuminance(words[illuminance]);
        if (words.size() > ground) read_ground(words[ground]);
    }
    scene_.add_light({"", objects_.current(), dome}, "sky-dome");
}

void MgfReader::perez_sky(MgfWords words) {
    constexpr std::size_t without_ground = 4, with_ground = 5;
    require_arguments(words, without_ground, with_ground, "vertex direct-normal diffuse-horizontal [ground]");
    SkyDome dome;
    dome.zenith = turned({0, 0, 1});
    dome.sun = -direction_of(words[1]);
    const double sine = std::clamp(static_cast<double>(dome.sun.dot(dome.zenith)), -1.0, 1.0);
    const double reflectance = words.size() == with_ground ? non_negative_argument(words[with_ground - 1]) : 0;
    ModelledDaylight perez;
    try {
        perez = perez_daylight(number_argument(words[2]), number_argument(words[3]), degrees(std::asin(sine)));
    } catch (const InputError& e) {
        throw MgfFault(e.what());
    }
    const auto light = [&](double illuminance) { return scene_.emitted(colours_.current(), illuminance, here()); };
    dome.model = perez.model;
    dome.irradiance = light(perez.sky_illuminance);
    if (perez.sky_illuminance > 0)
        dome.ground = static_cast<float>(reflectance * (1 + perez.sun_illuminance * sine / perez.sky_illuminance));
    scene_.add_light({"", objects_.current(), dome}, "sky-dome");
    if (perez.sun_illuminance > 0)
        scene_.add_light(
            {"", objects_.current(), DirectionalLight{-dome.sun, light(perez.sun_illuminance), sun_diameter}},
            "directional");
}

void MgfReader::environment(MgfWords words) {
    EnvironmentMap map;
    const double rotation = words.size() > 1 ? radians(number_argument(words[1])) : 0;
    map.factor = scene_.emitted(colours_.current(), words.size() > 2 ? non_negative_argument(words[2]) : 1, here());
    map.zenith = turned({0, 0, 1});
    map.north = turned({std::sin(rotation), std::cos(rotation), 0});
    map.image = environment_image(words[0]);
    scene_.add_light({"", objects_.current(), std::move(map)}, "environment");
}

std::shared_ptr<const Texture> MgfReader::environment_image(std::string_view name) {
    const std::filesystem::path path = file_->source.path.parent_path() / name;
    std::shared_ptr<const Texture>& image = environments_[path.string()];
    if (image) return image;
    try {
        image = read_environment(path);
    } catch (const InputError& unreadable) {
        throw MgfFault(fmt::format("the environment map {}", unreadable.what()));
    }
    scene_.add_file(path);
    return image;
}

}  // namespace interflect::detail
