#include "apps/interflect/render/pictures.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "apps/interflect/processes/long_work.h"
#include "interflect/image/files/pending_image.h"
#include "interflect/plots.h"

namespace interflect::command {

using namespace detail;

namespace {

bool has_only_black_pixels(const Image& image) {
    return std::all_of(image.pixels.begin(), image.pixels.end(), [](const Rgb& pixel) { return pixel == Rgb(0); });
}

/// Returns the exposure [stops]. Operators of absolute luminance choose the brightness themselves, so their automatic
/// exposure is 0.
float exposure_of(const Image& light, const RenderArguments& options) {
    const bool is_automatic = options.exposure.relative && !is_absolute(options.tonemap);
    return options.exposure.stops + (is_automatic ? automatic_exposure(light) : 0);
}

/// Draws measured light in false colours for display formats.
Picture picture_of_measured_light(const Image& light, const RenderArguments& options) {
    Picture picture;
    picture.quantity = options.label_of_numbers();
    const Image values = luminances(light);
    picture.image = options.is_for_display() ? options.false_colour.draw(values, options.legend_rows > 0) : values;
    return picture;
}

/// Applies tone mapping for display formats.
Picture picture_in_natural_colours(const Image& light, const RenderArguments& options) {
    Picture picture;
    picture.exposure = exposure_of(light, options);
    picture.image = options.is_for_display()
                        ? tone_map(light, *picture.exposure, options.tonemap, options.display_luminance)
                        : light;
    return picture;
}

ImageMetadata metadata_of(const Picture& picture, const View& view, const Scene& scene, std::uint64_t seed) {
    return {.view = view,
            .quantity = picture.quantity,
            .scene = scene.name,
            .version = INTERFLECT_VERSION,
            .seed = seed,
            .exposure = picture.exposure.value_or(0),
            .filter = picture.traced.filter};
}

}  // namespace

Picture picture_of_light(const Image& light, std::int64_t non_finite_pixels, const RenderArguments& options) {
    Picture picture = options.false_colour.measured ? picture_of_measured_light(light, options)
                                                    : picture_in_natural_colours(light, options);
    picture.non_finite_pixels = non_finite_pixels;
    picture.is_black = has_only_black_pixels(light);
    return picture;
}

Picture picture_of_quantity(QuantityPicture drawn, const RenderArguments& options) {
    Picture picture;
    picture.quantity = options.label_of_numbers();
    picture.non_finite_pixels = drawn.non_finite_pixels;
    if (!options.is_for_display())
        picture.image = std::move(drawn.values);
    else if (options.legend_rows > 0)
        picture.image = with_legend(drawn.shown, drawn.scale, picture.quantity);
    else
        picture.image = std::move(drawn.shown);
    return picture;
}

void write_picture(PendingFile& output, const Picture& picture, const View& view, const Scene& scene,
                   std::uint64_t seed, const RenderArguments& options) {
    const LongWork work(fmt::format("writing {}", options.output.string()));
    write_image(output, picture.image, metadata_of(picture, view, scene, seed),
                options.path.layers ? layers_of(picture.traced) : std::vector<ImageLayer>());
    if (picture.non_finite_pixels > 0)
        spdlog::warn("{} pixels have no valid value (overflow or NaN)", picture.non_finite_pixels);
    const bool is_exposed = picture.exposure && options.is_for_display();
    spdlog::info("{}: {} x {}, view '{}', {}{}", options.output.string(), picture.image.width, picture.image.height,
                 view.name, picture.quantity, is_exposed ? fmt::format(", exposure {:+.2f}", *picture.exposure) : "");
}

void write_interim_picture(const Picture& picture, const View& view, const Scene& scene,
                           const RenderArguments& options) {
    PendingFile output(options.output);
    write_image(output, picture.image, metadata_of(picture, view, scene, options.solver.seed()));
    spdlog::info("{}: picture so far; a better one will replace it", options.output.string());
}

}  // namespace interflect::command
