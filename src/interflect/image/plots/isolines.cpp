#include "interflect/plots.h"

#include <ImathVec.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "interflect/geometry/search/disjoint_sets.h"
#include "interflect/image/plots/lettering.h"

namespace interflect {

using namespace detail;

namespace {

using V2f = Imath::V2f;

// Lengths in dots of the font.
constexpr float line_width = 1, shortest_line = 16, label_spacing = 160;
constexpr int label_margin = 2;
/// Minimum relative difference of pixels across an edge of a surface or shadow, which no line follows.
constexpr float jump = 0.15f;

struct Field {
    int width = 0, height = 0;
    std::vector<float> values;  // [y * width + x]

    std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
    }
    float at(int x, int y) const { return values[index(std::clamp(x, 0, width - 1), std::clamp(y, 0, height - 1))]; }
};

Field smoothed(const Field& field, int dx, int dy) {
    constexpr std::array<float, 5> weights = {1.0f / 16, 4.0f / 16, 6.0f / 16, 4.0f / 16, 1.0f / 16};
    Field result = field;
    for (int y = 0; y < field.height; ++y)
        for (int x = 0; x < field.width; ++x) {
            float sum = 0;
            for (int k = 0; k < 5; ++k)
                sum += weights[static_cast<std::size_t>(k)] * field.at(x + (k - 2) * dx, y + (k - 2) * dy);
            result.values[field.index(x, y)] = sum;
        }
    return result;
}

Field field_of(const Image& image) {
    Field field{image.width, image.height, {}};
    field.values.reserve(image.pixels.size());
    for (const Rgb& pixel : image.pixels) field.values.push_back(std::isfinite(pixel.x) ? pixel.x : 0);
    return smoothed(smoothed(field, 1, 0), 0, 1);
}

/// Segment of an isoline [pixels].
struct Segment {
    V2f a, b;
    std::uint32_t line = 0;  // edge_id() that identifies its line
};

/// Isolines of one level, by marching squares.
class Contour {
  public:
    Contour(const Field& field, float level) : field_(field), level_(level), edges_(2 * field.values.size()) {
        for (int y = 0; y + 1 < field.height; ++y)
            for (int x = 0; x + 1 < field.width; ++x) cross_square(x, y);
        for (Segment& segment : segments_) segment.line = edges_.find(segment.line);
        for (const Segment& segment : segments_) lengths_[segment.line] += (segment.b - segment.a).length();
    }

    const std::vector<Segment>& segments() const { return segments_; }
    /// Returns the length of the line that contains the segment [pixels].
    float length(const Segment& segment) const { return lengths_.at(segment.line); }

  private:
    bool is_above(int x, int y) const { return field_.at(x, y) >= level_; }

    std::uint32_t edge_id(int x, int y, bool is_vertical) const {
        return static_cast<std::uint32_t>(2 * field_.index(x, y) + (is_vertical ? 1 : 0));
    }

    V2f crossing(int x, int y, bool is_vertical) const {
        const float a = field_.at(x, y), b = is_vertical ? field_.at(x, y + 1) : field_.at(x + 1, y);
        const float t = (level_ - a) / (b - a);
        return V2f(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f) + (is_vertical ? V2f(0, t) : V2f(t, 0));
    }

    void cross_square(int x, int y) {
        const bool top_left = is_above(x, y), top_right = is_above(x + 1, y), low_left = is_above(x, y + 1),
                   low_right = is_above(x + 1, y + 1);
        struct Edge {
            int x, y;
            bool is_vertical;
        };
        const Edge top{x, y, false}, left{x, y, true}, bottom{x, y + 1, false}, right{x + 1, y, true};
        const auto join = [&](const Edge& p, const Edge& q) {
            const std::uint32_t id = edge_id(p.x, p.y, p.is_vertical);
            edges_.unite(id, edge_id(q.x, q.y, q.is_vertical));
            segments_.push_back({crossing(p.x, p.y, p.is_vertical), crossing(q.x, q.y, q.is_vertical), id});
        };
        std::array<Edge, 4> crossed{};
        std::size_t count = 0;
        if (top_left != top_right) crossed[count++] = top;
        if (top_left != low_left) crossed[count++] = left;
        if (low_left != low_right) crossed[count++] = bottom;
        if (top_right != low_right) crossed[count++] = right;
        const auto [lowest, highest] =
            std::minmax({field_.at(x, y), field_.at(x + 1, y), field_.at(x, y + 1), field_.at(x + 1, y + 1)});
        if (highest - lowest > jump * std::abs(level_)) return;
        if (count == 2) join(crossed[0], crossed[1]);
        if (count < 4) return;
        // Saddle: the centre's value selects the connected corners.
        const float middle =
            (field_.at(x, y) + field_.at(x + 1, y) + field_.at(x, y + 1) + field_.at(x + 1, y + 1)) / 4;
        const bool with_top_left = (middle >= level_) == top_left;
        join(top, with_top_left ? right : left);
        join(bottom, with_top_left ? left : right);
    }

    const Field& field_;
    float level_;
    DisjointSets edges_;
    std::vector<Segment> segments_;
    std::unordered_map<std::uint32_t, float> lengths_;
};

float distance(const V2f& p, const Segment& s) {
    const V2f along = s.b - s.a;
    const float length2 = along.length2();
    const float t = length2 > 0 ? std::clamp((p - s.a).dot(along) / length2, 0.0f, 1.0f) : 0;
    return (p - (s.a + t * along)).length();
}

/// Adds the share of each pixel that the segment covers.
void add_coverage(const Segment& s, float half_width, Field& coverage) {
    const float reach = half_width + 1;
    const auto first = [&](float a, float b) { return std::max(0, static_cast<int>(std::min(a, b) - reach)); };
    const auto last = [&](float a, float b, int size) {
        return std::min(size - 1, static_cast<int>(std::max(a, b) + reach));
    };
    for (int y = first(s.a.y, s.b.y); y <= last(s.a.y, s.b.y, coverage.height); ++y)
        for (int x = first(s.a.x, s.b.x); x <= last(s.a.x, s.b.x, coverage.width); ++x) {
            const V2f centre(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
            float& covered = coverage.values[coverage.index(x, y)];
            covered = std::max(covered, std::clamp(half_width + 0.5f - distance(centre, s), 0.0f, 1.0f));
        }
}

void draw_lines(Image& image, const Contour& contour, int dot, const Rgb& colour) {
    Field coverage{image.width, image.height, std::vector<float>(image.pixels.size(), 0.0f)};
    for (const Segment& segment : contour.segments())
        if (contour.length(segment) >= shortest_line * static_cast<float>(dot))
            add_coverage(segment, line_width / 2 * static_cast<float>(dot), coverage);
    for (std::size_t i = 0; i < image.pixels.size(); ++i)
        image.pixels[i] += coverage.values[i] * (colour - image.pixels[i]);
}

/// Text and its rectangle [pixels].
struct Label {
    int left = 0, top = 0, width = 0, height = 0;
    std::string text;

    V2f middle() const {
        return {static_cast<float>(left) + static_cast<float>(width) / 2,
                static_cast<float>(top) + static_cast<float>(height) / 2};
    }
    bool overlaps(const Label& other) const {
        return left < other.left + other.width && other.left < left + width && top < other.top + other.height &&
               other.top < top + height;
    }
};

void place_labels(const Contour& contour, float level, int dot, const Image& image, std::vector<Label>& labels) {
    Label label{.text = fmt::format("{:.4g}", level)};
    label.width = text_width(label.text, dot) + 2 * label_margin * dot;
    label.height = (text_height + 2 * label_margin) * dot;
    const float min_length = 3 * static_cast<float>(label.width);
    std::vector<Segment> candidates = contour.segments();
    const auto off_centre = [&](const Segment& s) { return std::abs(s.a.y - static_cast<float>(image.height) / 2); };
    std::stable_sort(candidates.begin(), candidates.end(),
                     [&](const Segment& s, const Segment& t) { return off_centre(s) < off_centre(t); });
    for (const Segment& segment : candidates) {
        if (contour.length(segment) < min_length) continue;
        label.left = static_cast<int>(segment.a.x) - label.width / 2;
        label.top = static_cast<int>(segment.a.y) - label.height / 2;
        const bool fits = label.left >= 0 && label.top >= 0 && label.left + label.width <= image.width &&
                          label.top + label.height <= image.height;
        const bool is_free = std::none_of(labels.begin(), labels.end(), [&](const Label& other) {
            return label.overlaps(other) || (label.text == other.text && (label.middle() - other.middle()).length() <
                                                                             label_spacing * static_cast<float>(dot));
        });
        if (fits && is_free) labels.push_back(label);
    }
}

}  // namespace

Image with_isolines(const Image& picture, const Image& values, std::span<const float> levels,
                    const ColourScale& scale) {
    require_same_size(picture, values);
    const Field field = field_of(values);
    const int dot = dot_size(picture.width);
    Image image = picture;
    std::vector<Label> labels;
    for (const float level : levels) {
        const Contour contour(field, level);
        constexpr float bright = 0.5f;
        draw_lines(image, contour, dot, Rgb(scale.position(level) < bright ? 1 : 0));
        place_labels(contour, level, dot, image, labels);
    }
    for (const Label& label : labels) {
        fill(image, label.left, label.top, label.left + label.width, label.top + label.height, paper);
        write_text(image, label.left + label_margin * dot, label.top + label_margin * dot, label.text, dot);
    }
    return image;
}

}  // namespace interflect
