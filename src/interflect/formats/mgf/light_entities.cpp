// The entities `ies` and `light` (docs/files/mgf-extensions.md).
#include <fmt/format.h>

#include <cctype>
#include <functional>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "interflect/core.h"
#include "interflect/formats/mgf/reader.h"
#include "interflect/formats/reading/read_fault.h"
#include "interflect/formats/text/foreign_text.h"
#include "interflect/load.h"

namespace interflect::detail {

using Imath::V3d;

namespace {

bool is_name(std::string_view word) { return std::isalpha(static_cast<unsigned char>(word[0])) != 0; }

}  // namespace

V3f MgfReader::direction_of(std::string_view vertex) { return turned(normal_of(vertex)); }

V3f MgfReader::turned(const V3d& direction) const {
    V3d result;
    total_transform().multDirMatrix(direction, result);
    return V3f(result.normalized());
}

void MgfReader::light(MgfWords words) {
    struct Kind {
        std::size_t fewest, most;
        const char* usage;
    };
    static const std::unordered_map<std::string_view, Kind> kinds = {
        {"point", {3, 3, "light point vertex intensity"}},
        {"spot", {5, 5, "light spot vertex intensity inner-angle outer-angle"}},
        {"directional", {3, 4, "light directional vertex irradiance [diameter]"}},
        {"sky", {2, 11, "light sky radiance, or light sky name ..."}},
        {"environment", {2, 4, "light environment file [rotation [scale]]"}}};
    const auto kind = kinds.find(words[0]);
    if (kind == kinds.end())
        throw MgfFault(
            fmt::format("unknown light '{}'; expected point, spot, directional, sky or environment", words[0]));
    if (words.size() < kind->second.fewest || words.size() > kind->second.most)
        throw MgfFault(fmt::format("expected '{}', found {} argument{}", kind->second.usage, words.size(),
                                   words.size() == 1 ? "" : "s"));
    faults_.refuse(colours_.current().fault);
    if (words[0] == "sky" && (words.size() > 2 || is_name(words[1]))) return sky(words.subspan(1));
    if (words[0] == "environment") return environment(words.subspan(1));
    const double luminance = non_negative_argument(words[0] == "sky" ? words[1] : words[2]);
    const Rgb colour = scene_.emitted(colours_.current(), luminance, here());
    const auto position = [&] { return scene_.position(vertices_.find(words[1]).point * total_transform()); };
    const auto angle = [&](std::size_t i) { return static_cast<float>(number_argument(words[i])); };
    Luminaire luminaire{"", objects_.current(), UniformSky{colour}};
    if (words[0] == "point") luminaire.kind = PointLight{position(), colour};
    if (words[0] == "spot") luminaire.kind = SpotLight{position(), direction_of(words[1]), colour, angle(3), angle(4)};
    if (words[0] == "directional")
        luminaire.kind = DirectionalLight{direction_of(words[1]), colour, words.size() > 3 ? angle(3) : 0};
    const std::string name = kind_name(luminaire);
    scene_.add_light(std::move(luminaire), name);
}

/// Reads `ies`. Its transforms change neither flux nor size.
void MgfReader::luminaire(MgfWords words) {
    const std::string_view file = words[0];
    words = words.subspan(1);
    MgfColour colour;
    double multiplier = 1;
    constexpr std::size_t option_and_value = 2;
    bool by_top = false;
    while (!words.empty()) {
        if (words[0] == "-top") {
            by_top = true;
            words = words.subspan(1);
            continue;
        }
        if (words.size() < option_and_value || (words[0] != "-m" && words[0] != "-c")) break;
        if (words[0] == "-m")
            multiplier = non_negative_argument(words[1]);
        else
            colour = colours_.find(words[1]);
        words = words.subspan(option_and_value);
    }
    faults_.refuse(colour.fault);
    MeasuredLight light;
    light.web = photometric_web(file);
    light.factor = scene_.emitted(colour, multiplier, here());
    const TransformSequence sequence(words);
    std::vector<int> copy(sequence.array_sizes().size(), 0);
    const std::string name = std::filesystem::path(file).stem().string();
    do {
        add_luminaire(light, by_top, sequence.matrix(copy) * total_transform(), name);
    } while (next_index(copy, sequence.array_sizes()));
}

std::shared_ptr<const PhotometricWeb> MgfReader::photometric_web(std::string_view name) {
    const std::filesystem::path path = file_->source.path.parent_path() / name;
    std::shared_ptr<const PhotometricWeb>& web = webs_[path.string()];
    if (web) return web;
    try {
        Warnings warnings;
        web = std::make_shared<PhotometricWeb>(load_photometric_web(path, options_, warnings));
        for (const Warnings::Entry& w : warnings.entries())
            scene_.warnings().add(w.kind, without_quotes(w.message), w.where);
    } catch (const InputError& unreadable) {
        throw ReadFault(fmt::format("the luminaire {}", without_quotes(unreadable.what(), path.string().size())),
                        unreadable.fault().setting);
    }
    scene_.add_file(path);
    return web;
}

void MgfReader::add_luminaire(MeasuredLight light, bool by_top, const Imath::M44d& transform, const std::string& name) {
    const auto direction = [&](const V3d& v) {
        V3d result;
        transform.multDirMatrix(v, result);
        return V3f(result.normalized());
    };
    light.position = scene_.position(V3d(0) * transform);
    light.direction = direction({0, 0, -1});
    if (by_top) light.position += light.web->opening.mounting_depth() * light.direction;
    light.c0 = direction({1, 0, 0});
    light.mirrored = transform.determinant() < 0;
    scene_.add_light({"", objects_.current(), std::move(light)}, name);
}

}  // namespace interflect::detail
