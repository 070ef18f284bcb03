#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <array>
#include <cmath>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "apps/interflect/commands/commands.h"
#include "apps/interflect/values/distinct_files.h"
#include "apps/interflect/values/parse.h"
#include "interflect/base/files/pending_file.h"
#include "interflect/core.h"
#include "interflect/image.h"
#include "interflect/image/files/pending_image.h"
#include "interflect/metrics.h"

namespace interflect::command {

using namespace detail;

namespace {

using Json = nlohmann::ordered_json;

struct CompareArguments {
    std::filesystem::path image, reference;
    std::optional<double> field_of_view;  // [degrees]
    bool scale = false;
    std::optional<std::filesystem::path> difference;
    bool json = false;
};

Json to_json(const ImageDifference& d, double field_of_view) {
    Json blocks = Json::array();
    for (const BlockDifference& b : d.blocks)
        blocks.push_back({{"block", b.block},
                          {"relative_rmse", b.relative_rmse},
                          {"trimmed_relative_rmse", b.trimmed_relative_rmse}});
    return {{"ratio_of_means", d.ratio_of_means},
            {"rmse", d.rmse},
            {"relative_mse", d.relative_mse},
            {"maximum", d.maximum},
            {"perceptual_distance", d.perceptual_distance},
            {"fov", field_of_view},
            {"flip", d.flip},
            {"blocks", blocks},
            {"non_finite_pixels", d.non_finite_pixels}};
}

void print_text(const ImageDifference& d, double field_of_view) {
    fmt::print("ratio of mean luminances  {:.5g}\n", d.ratio_of_means);
    fmt::print("RMSE                      {:.5g}\n", d.rmse);
    fmt::print("relative MSE              {:.5g}\n", d.relative_mse);
    fmt::print("largest difference        {:.5g}\n", d.maximum);
    fmt::print("perceptual distance       {:.5g}  (field of view {:g} degrees)\n", d.perceptual_distance,
               field_of_view);
    fmt::print("FLIP                      {:.5g}\n", d.flip);
    for (const BlockDifference& b : d.blocks)
        fmt::print("relative RMSE, blocks of {} {:.5g}  ({:.5g} without the worst 1%)\n", b.block, b.relative_rmse,
                   b.trimmed_relative_rmse);
    if (d.non_finite_pixels > 0) fmt::print("pixels that are not finite {}\n", d.non_finite_pixels);
}

/// Returns the value of --fov; without it, the field of view of the reference, else of the image, else the default.
double field_of_view(const CompareArguments& options) {
    if (options.field_of_view) return *options.field_of_view;
    const std::optional<float> image = read_field_of_view(options.image);
    const std::optional<float> reference = read_field_of_view(options.reference);
    if (image && reference && *image != *reference)
        spdlog::warn("the fields of view differ, {:g} degrees in {} and {:g} in {}: taking the latter (--fov decides)",
                     *image, options.image.string(), *reference, options.reference.string());
    if (reference) return *reference;
    return image ? *image : CompareOptions().field_of_view;
}

void write_difference(PendingFile& file, const ImageDifference& difference) {
    if (difference.non_finite_pixels > 0)
        throw InputError(
            fmt::format("cannot draw the difference: {} pixels are not finite", difference.non_finite_pixels));
    write_image(file, show_flip_map(difference.flip_map));
}

bool is_tone_mapped(const std::filesystem::path& path) { return needs_tone_mapping(require_image_format(path)); }

void warn_of_unlike_values(const CompareArguments& options) {
    const bool image = is_tone_mapped(options.image), reference = is_tone_mapped(options.reference);
    if (image == reference) return;
    spdlog::warn("{} is tone-mapped for a display and {} holds linear values: the measures compare unlike things",
                 (image ? options.image : options.reference).string(),
                 (image ? options.reference : options.image).string());
}

void run(const CompareArguments& options) {
    std::optional<PendingFile> difference_file;
    if (options.difference) {
        require_distinct_files(
            std::array<NamedFile, 2>{{{"the image", options.image}, {"the reference", options.reference}}},
            std::array<NamedFile, 1>{{{"--difference", *options.difference}}});
        const ImageFormat format =
            check_option("--difference", [&] { return require_image_format(*options.difference); });
        if (!needs_tone_mapping(format))
            throw UsageError("--difference",
                             fmt::format("the difference is drawn to be looked at: expected .png or .jpg, found '{}'",
                                         options.difference->string()));
        difference_file.emplace(*options.difference);
    }
    const Image image = read_image(options.image), reference = read_image(options.reference);
    warn_of_unlike_values(options);
    const CompareOptions compare_options{
        .scale = options.scale,
        .field_of_view = field_of_view(options),
        .tone_mapped = is_tone_mapped(options.image) && is_tone_mapped(options.reference)};
    const ImageDifference difference = compare(image, reference, compare_options);
    if (difference_file) write_difference(*difference_file, difference);
    if (options.json)
        std::cout << to_json(difference, compare_options.field_of_view).dump(2) << '\n';
    else
        print_text(difference, compare_options.field_of_view);
}

}  // namespace

void add_compare(CLI::App& app) {
    const auto options = std::make_shared<CompareArguments>();
    CLI::App& command = *app.add_subcommand("compare", "Measure how a picture differs from a reference");
    command.add_option("IMAGE", options->image, "Picture (.exr .hdr .png)")->required()->type_name("FILE");
    command.add_option("REFERENCE", options->reference, "Reference: of the same size, or smaller by a whole factor")
        ->required()
        ->type_name("FILE");
    command.add_flag("--scale", options->scale, "Divide the ratio of mean luminances out first");
    command
        .add_option("--fov", options->field_of_view,
                    "Vertical field of view of the pictures [degrees], for the perceptual distance (default: as noted "
                    "in REFERENCE or IMAGE, .exr, else 45)")
        ->type_name("DEGREES")
        ->check(number_between(0.001, 179));
    command
        .add_option("--difference", options->difference,
                    "Also draw how different each pixel looks, its FLIP, in false colours with a legend (.png .jpg)")
        ->type_name("FILE");
    command.add_flag("--json", options->json, "As JSON on stdout");
    command.callback([options] { run(*options); });
}

}  // namespace interflect::command
