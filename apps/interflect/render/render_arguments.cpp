#include "apps/interflect/render/render_arguments.h"

#include <fmt/format.h>

#include <cmath>

#include "apps/interflect/drawing/drawing_time.h"
#include "apps/interflect/options/shading_options.h"

namespace interflect::command {

bool RenderArguments::is_for_display() const { return needs_tone_mapping(require_image_format(output)); }

std::string RenderArguments::label_of_numbers() const {
    return false_colour.measured ? false_colour.label() : label_of(shown);
}

std::array<NamedFile, 3> RenderArguments::outputs() const {
    return {{{"--output", output}, {"--stats", solver.stats}, {"--error-image", path.error_image}}};
}

bool RenderArguments::has_time_limit() const { return std::isfinite(solver.time()); }

double RenderArguments::seconds_left() const { return solver.time() - seconds_of_process(); }

void RenderArguments::add_to(CLI::App& command) {
    scene.add_to(command, std::string(scene_formats) + ", solved first, or solution file (.h5)");
    command.add_option("-o,--output", output, "Picture to write: .png .jpg .exr .hdr")->required()->type_name("FILE");
    view.add_to(command);
    section.add_to(command, {"--view", "--view-file", "--eye"});
    add_picture_to(command);
    path.add_to(command, picture);
    command.add_flag("--progressive", progressive,
                     "Write a rough picture after about a second, and better ones in its place until the last");
    add_tone_to(command);
    add_show(command, shown);
    false_colour.add_to(command);
    dimming.add_to(command);
    solver.add_to(command);
    command.get_option("--rays")->description(
        "Maximum number of rays, such as 20M (default 20M, unless --until is given)");
    command.get_option("--time")->description(
        "Maximum time of the whole command [s], divided between solving and drawing; if it is too short, light is "
        "traced for fewer pixels");
    mesh.add_to(command);
}

void RenderArguments::add_picture_to(CLI::App& command) {
    add_parsed(command, "--size", size, parse_size, "Picture size in pixels")
        ->type_name("WxH")
        ->default_str("1280x720");
    command
        .add_option("--samples", picture.samples,
                    fmt::format("Camera rays a pixel (default: {})", text_of_default_samples(&DefaultSamples::pixel)))
        ->check(CLI::Range(1, 65536));
    add_shading(command, picture.shading, &DefaultSamples::pixel, "pixel");
    command
        .add_option("--light-walks", picture.light_walks,
                    "Number of random walks that place virtual lights, for each batch of samples "
                    "(--shading instant)")
        ->capture_default_str()
        ->check(CLI::Range(1, 1 << 18))
        ->group(path_group);
}

void RenderArguments::add_tone_to(CLI::App& command) {
    add_parsed(command, "--exposure", exposure, parse_exposure,
               "Brightness of .png and .jpg: 1 more is twice as bright; auto+1 is twice as bright as auto. For "
               "ward, tumblin and ferwerda auto is 0: they choose the brightness")
        ->type_name("STOPS|auto[+-STOPS]")
        ->default_str("auto");
    add_choice<Tonemap>(command, "--tonemap", tonemap,
                        {{"srgb", Tonemap::srgb},
                         {"reinhard", Tonemap::reinhard},
                         {"filmic", Tonemap::filmic},
                         {"agx", Tonemap::agx},
                         {"ward", Tonemap::ward},
                         {"tumblin", Tonemap::tumblin},
                         {"ferwerda", Tonemap::ferwerda}},
                        "Tone mapping of .png and .jpg. srgb: true ratios, clipped; reinhard, filmic, agx: curves with "
                        "soft highlights; ward, tumblin, ferwerda: brightness by luminance [cd/m^2]")
        ->default_str("srgb");
    command
        .add_option("--display-luminance", display_luminance,
                    "Luminance of the display's white, for ward, tumblin and ferwerda [cd/m^2]")
        ->check(number_between(1, 10000))
        ->type_name("CD/M2")
        ->default_str("100");
}

}  // namespace interflect::command
