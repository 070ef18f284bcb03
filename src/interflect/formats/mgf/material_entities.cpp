#include "interflect/formats/mgf/reader.h"

#include <fmt/format.h>

#include <algorithm>

#include "interflect/formats/build/colour.h"
#include "interflect/formats/text/number.h"

namespace interflect::detail {

void MgfReader::colour_xy(MgfWords words) {
    constexpr double min_y = 1e-6;
    const Chromaticity c{number_argument(words[0]), number_argument(words[1])};
    if (c.x < 0 || c.y < 0 || c.x + c.y > 1)
        throw MgfFault(fmt::format("({}, {}) is no chromaticity: x >= 0, y >= 0, x + y <= 1", c.x, c.y));
    if (c.y < min_y)
        scene_.warn("no-luminance", "chromaticity without luminance (y = 0) is taken as one with y = 1e-6", here());
    colours_.current() = {{c.x, std::max(c.y, min_y)}};
}

void MgfReader::colour_spectrum(MgfWords words) {
    std::vector<double> values;
    for (const std::string_view word : words.subspan(2)) values.push_back(number_argument(word));
    colours_.current() = {chromaticity_of_spectrum(number_argument(words[0]), number_argument(words[1]), values)};
}

void MgfReader::colour_temperature(MgfWords words) {
    colours_.current() = {chromaticity_of_black_body(number_argument(words[0]))};
}

void MgfReader::colour_mix(MgfWords words) {
    if (words.size() % 2 != 0) throw MgfFault("cmix takes pairs of a weight and a colour");
    std::vector<MixedColour> parts;
    for (std::size_t i = 0; i < words.size(); i += 2) {
        const MgfColour& part = colours_.find(words[i + 1]);
        if (part.fault != none) {
            colours_.current() = part;
            return;
        }
        parts.push_back({number_argument(words[i]), part.chromaticity});
    }
    colours_.current() = {mix(parts)};
}

MgfMaterial& MgfReader::changed_material() {
    MgfMaterial& material = materials_.current();
    material.scene_index = none;
    material.defined = here();
    return material;
}

double MgfReader::fraction(std::string_view word) {
    const double value = non_negative_argument(word);
    if (value > 1) scene_.warn("reflectance-clamped", "reflectance or transmittance above 1 is taken as 1", here());
    return std::min(value, 1.0);
}

void MgfReader::material(MgfWords words) {
    materials_.enter(words);
    if (words.size() != 1) changed_material();
}

void MgfReader::sides(MgfWords words) {
    const int count = parse_integer(words[0]).value_or(0);
    if (count != 1 && count != 2) throw MgfFault(fmt::format("sides must be 1 or 2, not '{}'", words[0]));
    changed_material().two_sided = count == 2;
}

void MgfReader::diffuse_reflectance(MgfWords words) {
    MgfMaterial& material = changed_material();
    material.rd = non_negative_argument(words[0]);
    material.rd_colour = colours_.current();
}

void MgfReader::specular_reflectance(MgfWords words) {
    MgfMaterial& material = changed_material();
    material.rs = fraction(words[0]);
    material.rs_roughness = non_negative_argument(words[1]);
    material.rs_colour = colours_.current();
}

void MgfReader::specular_transmittance(MgfWords words) {
    MgfMaterial& material = changed_material();
    material.ts = fraction(words[0]);
    material.ts_roughness = non_negative_argument(words[1]);
    material.ts_colour = colours_.current();
}

void MgfReader::exitance(MgfWords words) {
    MgfMaterial& material = changed_material();
    material.ed = non_negative_argument(words[0]);
    material.ed_colour = colours_.current();
}

void MgfReader::texture(MgfWords words) {
    if (words[0] != "rd" && words[0] != "ts" && words[0] != "ed")
        throw MgfFault(fmt::format("a texture is one of rd, ts or ed, not of '{}'", words[0]));
    const std::filesystem::path path = file_->source.path.parent_path() / words[1];
    MgfMaterial& material = changed_material();
    MgfTexture& texture = words[0] == "rd"   ? material.rd_texture
                          : words[0] == "ts" ? material.ts_texture
                                             : material.ed_texture;
    texture = {path.string(), here()};
}

void MgfReader::refraction(MgfWords words) {
    if (!(number_argument(words[0]) > 0)) throw MgfFault("the real part of an index of refraction must be positive");
    number_argument(words[1]);
}

}  // namespace interflect::detail
