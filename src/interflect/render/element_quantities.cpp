#include <span>
#include <vector>

#include "interflect/core.h"
#include "interflect/elements/forest.h"
#include "interflect/render.h"
#include "interflect/render/pictures/outlines.h"
#include "interflect/render/pictures/path_picture.h"
#include "interflect/render/pictures/quantity_picture.h"

namespace interflect {

using namespace detail;

namespace {

Quantity described(ElementQuantity quantity) {
    switch (quantity) {
        case ElementQuantity::irradiance:
            return {"irradiance", "lm/m^2", {}, Spacing::logarithmic};
        case ElementQuantity::importance:
            return {"importance", "1/m^2", {}, Spacing::logarithmic};
        case ElementQuantity::direct_importance:
            return {"direct importance", "1/m^2", {}, Spacing::logarithmic};
        case ElementQuantity::level:
            return {"level of subdivision", "", {}, Spacing::linear};
        case ElementQuantity::rays:
            return {"rays that started", "1/m^2", {}, Spacing::logarithmic};
        default:
            return {"relative standard error of irradiance", "", {}, Spacing::logarithmic};
    }
}

std::vector<float> values_of(ElementQuantity quantity, const Solution& solution) {
    const ElementForest& forest = *solution.forest;
    std::vector<float> values(forest.size(), 0.0f);
    const auto fill = [&](const auto& value) {
        for (ElementIndex e{0}; e < forest.size(); ++e) values[e] = static_cast<float>(value(e));
    };
    const bool shows_importance =
        quantity == ElementQuantity::importance || quantity == ElementQuantity::direct_importance;
    if (shows_importance && solution.view_importance.empty())
        throw InputError("importance cannot be drawn: the scene was solved without a view");
    switch (quantity) {
        case ElementQuantity::irradiance:
            fill([&](ElementIndex e) { return luminance(solution.irradiance[e]); });
            break;
        case ElementQuantity::importance:
            fill([&](ElementIndex e) { return solution.view_importance[e] + solution.indirect_importance[e]; });
            break;
        case ElementQuantity::direct_importance:
            values = solution.view_importance;
            break;
        case ElementQuantity::level:
            fill([&](ElementIndex e) { return forest.level(e); });
            break;
        case ElementQuantity::rays:
            fill([&](ElementIndex e) { return solution.rays[e] / forest.area(e); });
            break;
        default:
            fill([&](ElementIndex e) {
                const float h = luminance(solution.irradiance[e]);
                return h > 0 ? solution.standard_error[e] / h : 0;
            });
    }
    return values;
}

}  // namespace

std::string label(ElementQuantity quantity) { return described(quantity).label(); }

QuantityPicture draw_quantity(const Scene& scene, const Solution& solution, const RayCaster& ray_caster,
                              const View& view, ElementQuantity quantity, const PictureOptions& options,
                              const Monitor& monitor) {
    const std::vector<float> values = values_of(quantity, solution);
    Quantity drawn = described(quantity);
    drawn.values = values;
    return render_quantity(scene, *solution.forest, ray_caster, view, drawn,
                           {options.width, options.height, options.samples, options.seed}, monitor);
}

Image draw_mesh(const Image& picture, const Scene& scene, const Solution& solution, const RayCaster& ray_caster,
                const View& view, int samples, std::uint64_t seed, const Monitor& monitor) {
    return draw_outlines(picture, scene, *solution.forest, ray_caster, view, samples, seed, {}, monitor);
}

std::size_t path_memory(std::size_t patches, const PictureOptions& options) {
    constexpr std::size_t bytes_per_patch = 250;
    // Measured for each walk: 3,600 bytes of virtual lights in a closed room of reflectance 0.9, and 550 in an office.
    constexpr std::size_t bytes_per_light_walk = 4000;
    const auto pixels = static_cast<std::size_t>(options.width) * static_cast<std::size_t>(options.height);
    const std::size_t walks = options.shading == Shading::instant ? static_cast<std::size_t>(options.light_walks) : 0;
    return patches * bytes_per_patch + pixels * path_bytes_per_pixel + walks * bytes_per_light_walk;
}

}  // namespace interflect
