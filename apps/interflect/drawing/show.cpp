#include "apps/interflect/drawing/show.h"

#include "apps/interflect/values/parse.h"
#include "interflect/core.h"

namespace interflect::command {

namespace {

/// @param shown  A quantity: is_quantity(shown) must be true.
ElementQuantity quantity_of(Shown shown) {
    switch (shown) {
        case Shown::irradiance:
            return ElementQuantity::irradiance;
        case Shown::importance:
            return ElementQuantity::importance;
        case Shown::direct_importance:
            return ElementQuantity::direct_importance;
        case Shown::level:
            return ElementQuantity::level;
        case Shown::rays:
            return ElementQuantity::rays;
        default:
            return ElementQuantity::error;
    }
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
                              const PictureOptions& options, const Monitor& monitor) {
    const bool needs_importance = shown == Shown::importance || shown == Shown::direct_importance;
    if (needs_importance && solved.solution.view_importance.empty())
        throw InputError("the solution has no importance: the scene was solved without a view (solve --view NAME)");
    return draw_quantity(solved.scene, solved.solution, ray_caster, view, quantity_of(shown), options, monitor);
}

std::string label_of(Shown shown) { return label(quantity_of(shown)); }

}  // namespace interflect::command
