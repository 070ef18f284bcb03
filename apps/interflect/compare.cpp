#include <fmt/format.h>

#include <cmath>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "apps/interflect/commands.h"
#include "interflect/image/image_files.h"
#include "interflect/image/metrics.h"

namespace interflect::command {

namespace {

using Json = nlohmann::ordered_json;

Json to_json(const ImageDifference& d) {
    Json blocks = Json::array();
    for (const BlockDifference& b : d.blocks)
        blocks.push_back({{"block", b.block},
                          {"relative_rmse", b.relative_rmse},
                          {"trimmed_relative_rmse", b.trimmed_relative_rmse}});
    return {{"ratio_of_means", d.ratio_of_means},
            {"rmse", d.rmse},
            {"relative_mse", d.relative_mse},
            {"maximum", d.maximum},
            {"blocks", blocks},
            {"non_finite_pixels", d.non_finite_pixels}};
}

void print_text(const ImageDifference& d) {
    fmt::print("ratio of mean luminances  {:.5g}\n", d.ratio_of_means);
    fmt::print("RMSE                      {:.5g}\n", d.rmse);
    fmt::print("relative MSE              {:.5g}\n", d.relative_mse);
    fmt::print("largest difference        {:.5g}\n", d.maximum);
    for (const BlockDifference& b : d.blocks)
        fmt::print("relative RMSE, blocks of {} {:.5g}  ({:.5g} without the worst 1%)\n", b.block, b.relative_rmse,
                   b.trimmed_relative_rmse);
    if (d.non_finite_pixels > 0) fmt::print("pixels that are not finite {}\n", d.non_finite_pixels);
}

}  // namespace

void add_compare(CLI::App& app) {
    struct Options {
        std::filesystem::path image, reference;
        CompareOptions compare;
        bool json = false;
    };
    const auto options = std::make_shared<Options>();
    CLI::App& command = *app.add_subcommand("compare", "Measure how a picture differs from a reference");
    command.add_option("IMAGE", options->image, "Picture (.exr .hdr .png)")->required()->type_name("FILE");
    command.add_option("REFERENCE", options->reference, "Reference: as large, or smaller by a whole factor")
        ->required()
        ->type_name("FILE");
    command.add_flag("--scale", options->compare.scale, "Divide the ratio of mean luminances out first");
    command.add_flag("--json", options->json, "As JSON on stdout");
    command.callback([options] {
        const Image image = read_image(options->image);
        const ImageDifference difference = compare(image, read_image(options->reference), options->compare);
        if (options->json)
            std::cout << to_json(difference).dump(2) << '\n';
        else
            print_text(difference);
    });
}

}  // namespace interflect::command
