#include "interflect/image.h"

#include <fmt/format.h>

#include <algorithm>

#include "interflect/core.h"

namespace interflect {

void require_pixels(const Image& image) {
    const auto size = static_cast<std::int64_t>(image.pixels.size());
    if (image.width < 1 || image.height < 1 || std::int64_t{image.width} * image.height != size)
        throw InputError(
            fmt::format("an image of {} x {} pixels that holds {}: expected 1 x 1 or more, and all of them",
                        image.width, image.height, size));
}

void require_same_size(const Image& image, const Image& reference) {
    if (image.width != reference.width || image.height != reference.height)
        throw InputError(fmt::format("images of {} x {} and {} x {} pixels: expected the same size", image.width,
                                     image.height, reference.width, reference.height));
    require_pixels(image);
    require_pixels(reference);
}

Image box_downsample(const Image& image, int factor) {
    if (factor < 1 || image.width % factor != 0 || image.height % factor != 0)
        throw InputError(
            fmt::format("cannot down-sample an image of {} x {} pixels by {}: expected a whole factor of both",
                        image.width, image.height, factor));
    require_pixels(image);
    if (factor == 1) return image;
    Image smaller(image.width / factor, image.height / factor);
    const double block_size = static_cast<double>(factor) * factor;
    for (int y = 0; y < smaller.height; ++y)
        for (int x = 0; x < smaller.width; ++x) {
            RgbD sum(0, 0, 0);
            for (int j = 0; j < factor; ++j)
                for (int i = 0; i < factor; ++i) sum += RgbD(image.at(x * factor + i, y * factor + j));
            smaller.at(x, y) = Rgb(sum / block_size);
        }
    return smaller;
}

std::int64_t count_non_finite(const Image& image) {
    return std::count_if(image.pixels.begin(), image.pixels.end(), [](const Rgb& pixel) { return !is_finite(pixel); });
}

}  // namespace interflect
