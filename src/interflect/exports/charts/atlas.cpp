#include "interflect/exports/charts/atlas.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>

#include "interflect/core.h"

#if defined(__GNUC__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wunused-function"
#endif
#define STBRP_STATIC
#define STB_RECT_PACK_IMPLEMENTATION
#include <stb/stb_rect_pack.h>
#if defined(__GNUC__)
#pragma GCC diagnostic pop
#endif

namespace interflect::detail {

namespace {

int to_multiple_of_4(int size) { return (size + 3) / 4 * 4; }

struct Packing {
    std::vector<stbrp_rect> rectangles;
    Imath::V2i size{0, 0};
    std::int64_t packed_area = 0;
    bool is_complete = true;

    std::int64_t area() const { return std::int64_t{size.x} * size.y; }
};

Packing pack(std::vector<stbrp_rect> rectangles, int width, int height) {
    stbrp_context context;
    std::vector<stbrp_node> nodes(static_cast<std::size_t>(width));
    stbrp_init_target(&context, width, height, nodes.data(), width);
    stbrp_pack_rects(&context, rectangles.data(), static_cast<int>(rectangles.size()));
    Packing packing;
    for (const stbrp_rect& r : rectangles) {
        if (!r.was_packed) {
            packing.is_complete = false;
            continue;
        }
        packing.size.x = std::max(packing.size.x, to_multiple_of_4(r.x + r.w));
        packing.size.y = std::max(packing.size.y, to_multiple_of_4(r.y + r.h));
        packing.packed_area += std::int64_t{r.w} * r.h;
    }
    packing.rectangles = std::move(rectangles);
    return packing;
}

/// @param lying  Whether the longer sides are horizontal.
std::vector<stbrp_rect> rectangles_of(const std::vector<LightmapChart>& charts, const std::vector<int>& chosen,
                                      int gutter, bool lying) {
    std::vector<stbrp_rect> rectangles;
    for (const int i : chosen) {
        const LightmapChart& chart = charts[static_cast<std::size_t>(i)];
        const auto [low, high] = std::minmax({chart.columns + 2 * gutter, chart.rows + 2 * gutter});
        rectangles.push_back({i, lying ? high : low, lying ? low : high, 0, 0, 0});
    }
    return rectangles;
}

/// Returns the smallest packing of all chosen charts. If they do not fit into an image, returns the fullest image
/// found.
Packing best_packing(const std::vector<LightmapChart>& charts, const std::vector<int>& chosen, int gutter,
                     int max_size) {
    constexpr std::size_t many_charts = 2000;  // packing them takes minutes, so fewer widths are tried
    const int trials = chosen.size() > many_charts ? 6 : 96;
    std::optional<Packing> best;
    for (const bool lying : {true, false}) {
        const std::vector<stbrp_rect> rectangles = rectangles_of(charts, chosen, gutter, lying);
        double area = 0;
        int widest = 0;
        for (const stbrp_rect& r : rectangles) {
            area += static_cast<double>(r.w) * r.h;
            widest = std::max(widest, r.w);
        }
        // Try widths of images from about half as wide as high to twice as wide as high
        const double narrowest = std::max<double>(widest, std::sqrt(area / 2));
        const double broadest = std::max(narrowest, std::min<double>(max_size, std::sqrt(2 * area)));
        for (int i = 0; i <= trials; ++i) {
            const double width = narrowest + (broadest - narrowest) * i / trials;
            Packing packing = pack(rectangles, std::min(to_multiple_of_4(static_cast<int>(width)), max_size), max_size);
            if (packing.is_complete && (!best || packing.area() < best->area())) best = std::move(packing);
        }
    }
    if (best) return *std::move(best);
    Packing lying = pack(rectangles_of(charts, chosen, gutter, true), max_size, max_size);
    Packing standing = pack(rectangles_of(charts, chosen, gutter, false), max_size, max_size);
    return lying.packed_area >= standing.packed_area ? lying : standing;
}

/// Rotates a chart by 90 degrees.
void rotate(LightmapChart& chart) {
    for (FlatPatch& flat : chart.patches)
        for (Imath::V2d& corner : flat.corners) corner = {corner.y, chart.size.x - corner.x};
    std::swap(chart.size.x, chart.size.y);
    std::swap(chart.columns, chart.rows);
}

std::vector<int> index_range(std::size_t begin, std::size_t end) {
    std::vector<int> numbers;
    for (std::size_t i = begin; i < end; ++i) numbers.push_back(static_cast<int>(i));
    return numbers;
}

/// Moves charts to their places in image `page`. Returns the charts that were not packed.
std::vector<int> place(const Packing& packing, int page, int gutter, std::vector<LightmapChart>& charts) {
    std::vector<int> remaining;
    for (const stbrp_rect& r : packing.rectangles) {
        if (!r.was_packed) {
            remaining.push_back(r.id);
            continue;
        }
        LightmapChart& chart = charts[static_cast<std::size_t>(r.id)];
        if (chart.columns + 2 * gutter != r.w) rotate(chart);
        chart.page = page;
        chart.left = r.x + gutter;
        chart.top = r.y + gutter;
    }
    return remaining;
}

/// Halves the resolution of a chart. Returns whether it changed.
bool halve(LightmapChart& chart) {
    const bool is_smallest = chart.columns == 2 && chart.rows == 2;
    chart.columns = std::max(2, chart.columns / 2);
    chart.rows = std::max(2, chart.rows / 2);
    return !is_smallest;
}

}  // namespace

std::vector<Imath::V2i> pack_charts(std::vector<LightmapChart>& charts, int gutter, int max_size) {
    std::vector<Imath::V2i> sizes;
    std::vector<int> remaining = index_range(0, charts.size());
    while (!remaining.empty()) {
        const Packing packing = best_packing(charts, remaining, gutter, max_size);
        remaining = place(packing, static_cast<int>(sizes.size()), gutter, charts);
        sizes.push_back(packing.size);
    }
    return sizes;
}

std::vector<Imath::V2i> pack_groups(std::vector<LightmapChart>& charts, const std::vector<std::uint32_t>& first,
                                    int gutter, int max_size) {
    std::vector<Imath::V2i> sizes;
    const auto begin_of = [&](std::size_t group) { return group < first.size() ? first[group] : charts.size(); };
    std::size_t next = 0;
    while (next < first.size()) {
        const auto packed_to = [&](std::size_t end) {
            return best_packing(charts, index_range(begin_of(next), begin_of(end)), gutter, max_size);
        };
        // Find the largest number of groups that fits into an image, by bisection
        std::size_t end = first.size();
        Packing packing = packed_to(end);
        if (!packing.is_complete) {
            std::size_t too_many = end;
            for (end = next; too_many > end + 1;) {
                const std::size_t middle = (end + too_many) / 2;
                Packing tried = packed_to(middle);
                if (!tried.is_complete) {
                    too_many = middle;
                    continue;
                }
                end = middle;
                packing = std::move(tried);
            }
        }
        // Halve the resolution of a group that is too large
        if (end == next) {
            bool is_smaller = false;
            for (const int i : index_range(begin_of(next), begin_of(next + 1)))
                is_smaller |= halve(charts[static_cast<std::size_t>(i)]);
            if (!is_smaller)
                throw InputError(
                    Fault{.text = fmt::format("lightmap: an object of {} charts does not fit into an image "
                                              "of {} x {} texels: expected a larger max_size",
                                              begin_of(next + 1) - begin_of(next), max_size, max_size),
                          .setting = "max_size"});
            continue;
        }
        place(packing, static_cast<int>(sizes.size()), gutter, charts);
        sizes.push_back(packing.size);
        next = end;
    }
    return sizes;
}

}  // namespace interflect::detail
