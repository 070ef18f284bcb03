#include "interflect/image/plots/lettering.h"

#include <stb/stb_easy_font.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <vector>

namespace interflect::detail {

int dot_size(int picture_width) {
    constexpr int dots = 512;  // approximate width of a picture
    return std::max(1, (picture_width + dots / 4) / dots);
}

void fill(Image& image, int left, int top, int right, int bottom, const Rgb& colour) {
    for (int y = std::max(top, 0); y < std::min(bottom, image.height); ++y)
        for (int x = std::max(left, 0); x < std::min(right, image.width); ++x) image.at(x, y) = colour;
}

int text_width(std::string text, int dot) { return dot * stb_easy_font_width(text.data()); }

void write_text(Image& image, int left, int top, std::string text, int dot) {
    struct Vertex {
        float x, y, z;
        std::array<unsigned char, 4> colour;
    };
    using Rectangle = std::array<Vertex, 4>;  // clockwise from the top left
    constexpr std::size_t max_per_letter = 24;
    std::vector<Rectangle> rectangles(max_per_letter * text.size());
    const int count = stb_easy_font_print(0, 0, text.data(), nullptr, rectangles.data(),
                                          static_cast<int>(rectangles.size() * sizeof(Rectangle)));
    rectangles.resize(static_cast<std::size_t>(count));
    const auto pixels = [&](float dots) { return static_cast<int>(std::lround(dots)) * dot; };
    for (const Rectangle& r : rectangles)
        fill(image, left + pixels(r[0].x), top + pixels(r[0].y), left + pixels(r[2].x), top + pixels(r[2].y), ink);
}

}  // namespace interflect::detail
