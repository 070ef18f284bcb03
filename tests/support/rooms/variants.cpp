#include "tests/support/rooms/variants.h"

#include <algorithm>
#include <iterator>

#include "interflect/elements/forest.h"
#include "tests/support/scenes/scenes.h"

namespace interflect::testing_support {

using namespace detail;

namespace {

Variant plain(const char* method) {
    Variant variant{method, {}};
    variant.options.method = find_method(method);
    return variant;
}

Variant flat(bool separate) {
    Variant variant = plain("isrr");
    variant.name += separate ? "_si" : "_ci";
    variant.options.experimental.separate_iterations = separate;
    return variant;
}

/// Returns one of the paper's eight variants, with the names of docs/method/method.md.
Variant hierarchical(bool separate, bool deferred, bool at_elements) {
    Variant variant = plain("ihsrr");
    variant.name += std::string(separate ? "_si" : "_ci") + (deferred ? "_dr" : "") + (at_elements ? "_hi" : "");
    variant.options.experimental.separate_iterations = separate;
    variant.options.experimental.defer_refinement = deferred;
    variant.options.experimental.importance_at_patches = !at_elements;
    return variant;
}

bool keeps_every_ray(const Variant& variant) { return std::string_view(variant.options.method.name).ends_with("wdrs"); }

template <class Condition>
std::vector<Variant> those(const Condition& condition) {
    const std::vector<Variant> all = stochastic_variants();
    std::vector<Variant> some;
    std::copy_if(all.begin(), all.end(), std::back_inserter(some),
                 [&](const Variant& variant) { return condition(variant.options.method); });
    return some;
}

}  // namespace

const View into_the_corner{"corner", {0.9f, 1.9f, 2.5f}, {0.1f, 0.4f, 0.2f}, {0, 0, 1}, 40};

std::ostream& operator<<(std::ostream& out, const Variant& variant) { return out << variant.name; }

std::vector<Variant> stochastic_variants() {
    std::vector<Variant> variants{plain("srr"), flat(true), flat(false), plain("hsrr")};
    for (const bool separate : {true, false})
        for (const bool deferred : {false, true})
            for (const bool at_elements : {false, true})
                variants.push_back(hierarchical(separate, deferred, at_elements));
    return variants;
}

std::vector<Variant> variants_of_other_methods() {
    std::vector<Variant> named = stochastic_variants(), others;
    const std::vector<Variant> kept = variants_that_keep_every_ray();
    named.insert(named.end(), kept.begin(), kept.end());
    for (const Method& method : methods) {
        const auto is_of_it = [&](const Variant& v) { return std::string_view(v.options.method.name) == method.name; };
        if (!method.is_stochastic || std::any_of(named.begin(), named.end(), is_of_it)) continue;
        others.push_back(plain(method.name));
        std::replace(others.back().name.begin(), others.back().name.end(), '-', '_');
    }
    return others;
}

std::vector<Variant> variants_that_keep_every_ray() { return {plain("wdrs"), plain("hwdrs"), plain("ihwdrs")}; }

std::vector<Variant> variants_with_importance() {
    return those([](const Method& method) { return method.importance != ImportanceUse::off; });
}

std::vector<Variant> extreme_variants() {
    std::vector<Variant> variants;
    const auto add = [&](const char* name, const auto& change, const char* method = "ihsrr") {
        variants.push_back(plain(method));
        variants.back().name = name;
        change(variants.back().options);
    };
    add("alpha_0", [](SolveOptions& o) { o.experimental.alpha = 0; });
    add("alpha_1", [](SolveOptions& o) { o.experimental.alpha = 1; });
    add("beta_0", [](SolveOptions& o) { o.experimental.beta = 0; });
    add("beta_1", [](SolveOptions& o) { o.experimental.beta = 1; });
    add("inherited_trust_0", [](SolveOptions& o) { o.experimental.inherited_weight = 0; });
    add("inherited_trust_1", [](SolveOptions& o) { o.experimental.inherited_weight = 1; });
    add("total_importance", [](SolveOptions& o) {
        o.experimental.total_importance = true;
        o.experimental.beta = 0;
    });
    // Flat mesh: invisible patches have no importance, so they would receive as a whole.
    const auto direct = [](SolveOptions& o) { o.method.importance = ImportanceUse::direct; };
    add("direct_importance", direct, "isrr");
    return variants;
}

void divide_everything(SolveOptions& options, double min_area) {
    options.experimental.epsilon = 1e-12;
    options.refinement.min_area = min_area;
}

SolveOptions on_a_fixed_mesh(const Variant& variant, std::uint64_t seed) {
    SolveOptions options = variant.options;
    options.views = {{into_the_corner}};
    options.seed = seed;
    // A kept ray has the colour of its shooting, before any warm-up.
    options.experimental.one_bounce = !keeps_every_ray(variant);
    options.refinement.criterion = RefinementCriterion::power;  // no shrinkage
    options.experimental.warm_up = 12;                          // mean reflectances are below 0.55: 0.55^12 < 0.001
    options.experimental.iterations = 4;
    options.experimental.rays_per_iteration = 10'000;
    divide_everything(options, options.experimental.defer_refinement ? left_whole : divided_once);
    return options;
}

std::vector<ElementIndex> leaves_by_place(const ElementForest& forest) {
    std::vector<ElementIndex> leaves = forest.leaves();
    std::sort(leaves.begin(), leaves.end(), [&](ElementIndex a, ElementIndex b) {
        return std::pair(forest.patch(a), forest.path(a)) < std::pair(forest.patch(b), forest.path(b));
    });
    return leaves;
}

Scene scene_of_leaves(const Scene& scene, const ElementForest& forest) {
    Scene leaves;
    leaves.name = "the leaves of " + scene.name;
    leaves.materials = scene.materials;
    for (const ElementIndex leaf : leaves_by_place(forest)) {
        const PatchIndex patch = forest.patch(leaf);
        const Cell cell = forest.cell(leaf);
        const auto corner = [&](float s, float t) { return forest.geometry(patch).point(cell.at(s, t)); };
        add_rectangle(leaves, corner(0, 0), corner(1, 0) - corner(0, 0), corner(0, 1) - corner(0, 0),
                      scene.patches[patch].material);
    }
    return leaves;
}

}  // namespace interflect::testing_support
