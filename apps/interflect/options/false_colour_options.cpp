#include "apps/interflect/options/false_colour_options.h"

#include "interflect/core.h"
#include "interflect/plots.h"

namespace interflect::command {

using namespace detail;

namespace {

ColourScale scale_for(const Image& values, const FalseColourOptions& options) {
    const Spacing spacing = options.logarithmic ? Spacing::logarithmic : Spacing::linear;
    if (options.scale) return {options.scale->low, options.scale->high, spacing};
    std::vector<float> numbers;
    numbers.reserve(values.pixels.size());
    for (const Rgb& pixel : values.pixels) numbers.push_back(pixel.x);
    return options.logarithmic ? fit_scale(std::move(numbers), spacing) : fit_round_scale(std::move(numbers));
}

/// Returns round values between the ends of the scale.
std::vector<float> automatic_isolines(const ColourScale& scale) {
    constexpr int most = 10;
    std::vector<float> values = round_values(scale, most);
    std::erase_if(values, [&](float v) { return v <= scale.low || v >= scale.high; });
    return values;
}

}  // namespace

void FalseColourOptions::add_to(CLI::App& app) {
    const auto group = [](CLI::Option* option) {
        option->group("False colours");
        return option;
    };
    group(add_choice<Measured>(
        app, "--false-colour", measured, {{"lux", Measured::illuminance}, {"cd/m2", Measured::luminance}},
        "Illuminance of the visible surfaces, or luminance of the picture; numbers in .exr and .hdr"));
    group(add_parsed(app, "--scale", scale, parse_range, "Values of the first and the last colour")
              ->type_name("LOW..HIGH"));
    group(app.add_flag("--logarithmic", logarithmic, "Equal ratios have equal steps of colour"));
    group(add_parsed(app, "--isolines", isolines, parse_isolines, "Draw lines of equal value with numbers on them")
              ->type_name("auto|V1,V2,..."));
}

void FalseColourOptions::check() const {
    if (!measured && (scale || logarithmic || isolines))
        throw UsageError("--scale, --logarithmic and --isolines have no effect without --false-colour");
    if (logarithmic && scale && scale->low == 0)
        throw UsageError("--scale from 0: a logarithmic scale has no 0, expected a number above it");
}

std::string FalseColourOptions::label() const {
    return measured == Measured::illuminance ? "illuminance [lx]" : "luminance [cd/m^2]";
}

Image FalseColourOptions::draw(const Image& values, bool has_legend) const {
    const ColourScale colours = scale_for(values, *this);
    Image image = false_colours(values, colours);
    if (isolines)
        image = with_isolines(image, values, isolines->empty() ? automatic_isolines(colours) : *isolines, colours);
    return has_legend ? with_legend(image, colours, label()) : image;
}

Image luminances(const Image& light) {
    Image values = light;
    for (Rgb& pixel : values.pixels) pixel = Rgb(luminance(pixel));
    return values;
}

}  // namespace interflect::command
