#include "interflect/exports/charts/layouts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "interflect/geometry/search/box_tree.h"

namespace interflect::detail {

namespace {

/// Tolerance of coordinates in the unit square, which exceeds the rounding to 16 bits.
constexpr double layout_rounding = 0x1p-15;

/// Returns the patch in the layout of its object, with v pointing downwards.
FlatPatch given_layout(const Scene& scene, PatchIndex p) {
    const Patch& patch = scene.patches[p];
    FlatPatch flat{p, patch.vertex_count()};
    for (int c = 0; c < flat.count; ++c) {
        const V2f& at = scene.lightmap_coordinates[patch.vertices[c]];
        flat.corners[static_cast<std::size_t>(c)] = {at.x, 1.0 - at.y};
    }
    return flat;
}

/// Minimum share of its bounding box that a layout fills. It is small because several objects may share a map.
constexpr double min_filled = 0.1;

bool is_mostly_empty(const FlatPatches& layout) {
    Imath::Box2d box;
    double area = 0;
    for (const FlatPatch& flat : layout) {
        box.extendBy(flat.box());
        area += std::abs(flat.signed_area());
    }
    return area < min_filled * box.size().x * box.size().y;
}

bool overlaps_itself(const FlatPatches& layout) {
    const auto box_of = [](const FlatPatch& flat) {
        const Imath::Box2d box = flat.box();
        return Imath::Box3f(V3f(static_cast<float>(box.min.x), static_cast<float>(box.min.y), 0),
                            V3f(static_cast<float>(box.max.x), static_cast<float>(box.max.y), 0));
    };
    std::vector<Boxed> tree;
    for (std::uint32_t i = 0; i < layout.size(); ++i) tree.push_back({box_of(layout[i]), i});
    arrange_box_tree(tree);
    return std::any_of(layout.begin(), layout.end(), [&](const FlatPatch& flat) {
        bool overlaps = false;
        const auto reaches = [&, box = box_of(flat)](const Imath::Box3f& other) {
            return !overlaps && box.intersects(other);
        };
        visit_box_tree(std::span<const Boxed>(tree), reaches, [&](std::uint32_t j) {
            if (layout[j].patch != flat.patch && separation(flat, layout[j]) < -layout_rounding) overlaps = true;
        });
        return overlaps;
    });
}

const char* fault_of(const FlatPatches& layout) {
    const auto has_no_area = [](const FlatPatch& flat) {
        return std::abs(flat.signed_area()) < layout_rounding * layout_rounding;
    };
    if (std::any_of(layout.begin(), layout.end(), has_no_area)) return "gives a face no area";
    if (overlaps_itself(layout)) return "overlaps itself";
    if (is_mostly_empty(layout)) return "is mostly empty";
    return nullptr;
}

void scale(const Scene& scene, FlatPatches& layout) {
    double flat_area = 0, area = 0;
    for (const FlatPatch& flat : layout) {
        flat_area += std::abs(flat.signed_area());
        area += PatchGeometry(scene, scene.patches[flat.patch]).area();
    }
    for (FlatPatch& flat : layout)
        for (Imath::V2d& corner : flat.corners) corner *= std::sqrt(area / flat_area);
}

}  // namespace

std::vector<FlatPatches> kept_layouts(const Scene& scene, const std::vector<bool>& shown, Warnings* warnings) {
    if (scene.lightmap_coordinates.empty()) return {};
    std::map<std::uint32_t, FlatPatches> layout_of_object;
    for (PatchIndex p{0}; p < scene.patches.size(); ++p) {
        const Patch& patch = scene.patches[p];
        const bool is_second_side = patch.other_side < p && shown[patch.other_side];
        if (shown[p] && !is_second_side && !std::isnan(scene.lightmap_coordinates[patch.vertices[0]].x))
            layout_of_object[patch.object].push_back(given_layout(scene, p));
    }
    std::vector<FlatPatches> layouts;
    for (auto& [object, layout] : layout_of_object) {
        if (const char* fault = fault_of(layout)) {
            if (warnings)
                warnings->add("lightmap-layout",
                              fmt::format("the object's lightmap layout {}: it gets a new one", fault),
                              scene.objects[object]);
            continue;
        }
        scale(scene, layout);
        layouts.push_back(std::move(layout));
    }
    return layouts;
}

}  // namespace interflect::detail
