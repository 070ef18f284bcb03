#include "apps/interflect/drawing/show.h"

#include <vector>

#include "apps/interflect/values/parse.h"
#include "interflect/core.h"
#include "interflect/elements/forest.h"
#include "interflect/render/pictures/camera_samples.h"

namespace interflect::command {

using namespace detail;

namespace {

Quantity described(Shown shown) {
    switch (shown) {
        case Shown::irradiance:
            return {"irradiance", "lm/m^2", {}, Spacing::logarithmic};
        case Shown::importance:
            return {"importance", "1/m^2", {}, Spacing::logarithmic};
        case Shown::direct_importance:
            return {"direct importance", "1/m^2", {}, Spacing::logarithmic};
        case Shown::level:
            return {"level of subdivision", "", {}, Spacing::linear};
        case Shown::rays:
            return {"rays that started", "1/m^2", {}, Spacing::logarithmic};
        default:
            return {"relative standard error of irradiance", "", {}, Spacing::logarithmic};
    }
}

std::vector<float> values_of(Shown shown, const Solution& solution) {
    const ElementForest& forest = *solution.forest;
    std::vector<float> values(forest.size(), 0.0f);
    const auto fill = [&](const auto& value) {
        for (std::uint32_t e = 0; e < forest.size(); ++e) values[e] = static_cast<float>(value(e));
    };
    const bool needs_importance = shown == Shown::importance || shown == Shown::direct_importance;
    if (needs_importance && solution.view_importance.empty())
        throw InputError("the solution has no importance: the scene was solved without a view (solve --view NAME)");
    switch (shown) {
        case Shown::irradiance:
            fill([&](std::uint32_t e) { return luminance(solution.irradiance[e]); });
            break;
        case Shown::importance:
            fill([&](std::uint32_t e) { return solution.view_importance[e] + solution.indirect_importance[e]; });
            break;
        case Shown::direct_importance:
            values = solution.view_importance;
            break;
        case Shown::level:
            fill([&](std::uint32_t e) { return forest.level(e); });
            break;
        case Shown::rays:
            fill([&](std::uint32_t e) { return solution.rays[e] / forest.area(e); });
            break;
        default:
            fill([&](std::uint32_t e) {
                const float h = luminance(solution.irradiance[e]);
                return h > 0 ? solution.standard_error[e] / h : 0;
            });
    }
    return values;
}

}  // namespace

void add_show(CLI::App& app, Shown& shown) {
    add_choice<Shown>(
        app, "--show", shown,
        {{"light", Shown::light},
         {"mesh", Shown::mesh},
         {"irradiance", Shown::irradiance},
         {"importance", Shown::importance},
         {"direct-importance", Shown::direct_importance},
         {"level", Shown::level},
         {"rays", Shown::rays},
         {"error", Shown::error}},
        "Quantity to draw: the light, the light with the mesh, or a quantity of the elements with a legend")
        ->default_str("light");
}

QuantityPicture show_quantity(Shown shown, const SolvedScene& solved, const RayCaster& ray_caster, const View& view,
                              const CameraSampling& sampling, const Monitor& monitor) {
    const std::vector<float> values = values_of(shown, solved.solution);
    Quantity quantity = described(shown);
    quantity.values = values;
    return render_quantity(solved.scene, *solved.solution.forest, ray_caster, view, quantity, sampling, monitor);
}

std::string label_of(Shown shown) { return described(shown).label(); }

}  // namespace interflect::command
