#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "apps/interflect/drawing/run_path_tracer.h"
#include "apps/interflect/render/render_arguments.h"
#include "interflect/base/files/pending_file.h"
#include "interflect/image.h"
#include "interflect/render.h"
#include "interflect/scene.h"

namespace interflect::command {

/// A picture with its metadata, ready to be written: tone-mapped or in false colours for display formats.
struct Picture {
    Image image;
    std::string quantity = "radiance [cd/m^2]";
    std::optional<float> exposure;  ///< [stops]; empty for pictures of numbers.
    std::int64_t non_finite_pixels = 0;
    bool is_black = false;   ///< Whether no pixel of the drawn light is lit.
    TracedPicture traced{};  ///< Result of path tracing, for the layers of the file; empty in other shadings.
};

/// Converts drawn light to a picture. @param light  Radiance, or irradiance for --false-colour lux.
Picture picture_of_light(const Image& light, std::int64_t non_finite_pixels, const RenderArguments& options);

/// Converts a drawn quantity of the elements to a picture.
Picture picture_of_quantity(QuantityPicture drawn, const RenderArguments& options);

/// Writes the final picture and logs its properties. @param seed  Of the solution, or of path tracing without one.
void write_picture(detail::PendingFile& output, const Picture& picture, const View& view, const Scene& scene,
                   std::uint64_t seed, const RenderArguments& options);

/// Writes a picture that a better one will replace.
void write_interim_picture(const Picture& picture, const View& view, const Scene& scene,
                           const RenderArguments& options);

}  // namespace interflect::command
