#include "interflect/formats/rad/materials.h"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "interflect/formats/build/material_limits.h"
#include "interflect/scene/core/limits.h"

namespace interflect::detail {

namespace {

/// Type of modifiers that an ignored command may define.
constexpr std::string_view missing_type = "of a command";

Rgb colour_of(const RadPrimitive& p) {
    Rgb colour;
    for (int c = 0; c < 3; ++c) {
        if (p.numbers[c] < 0)
            throw std::invalid_argument(fmt::format("its colour has the negative value {}", p.numbers[c]));
        colour[c] = static_cast<float>(p.numbers[c]);
    }
    return colour;
}

float share(const RadPrimitive& p, std::size_t i, const char* what) {
    if (!(p.numbers[i] >= 0 && p.numbers[i] <= 1))
        throw std::invalid_argument(fmt::format("its {} is {}; expected 0 to 1", what, p.numbers[i]));
    return static_cast<float>(p.numbers[i]);
}

/// Returns the roughness. Measured and procedural BRDFs count as rough.
double roughness_of(const RadPrimitive& p) {
    if (p.type.ends_with("func") || p.type.ends_with("data")) return 1;
    return p.type.ends_with('2') ? std::max(p.numbers[4], p.numbers[5]) : p.numbers[4];
}

}  // namespace

GlassShares glass_shares(double transmissivity, double index) {
    const double root = (index - 1) / (index + 1);
    const double r = root * root, t = transmissivity;  // reflectance of one surface, transmittance of the interior
    const double passed = (1 - r) * (1 - r) / (1 - r * r * t * t);
    return {passed * t, r + r * passed * t * t};
}

const std::unordered_map<std::string_view, RadMaterials::Type>& RadMaterials::types() {
    using enum Role;
    constexpr Type pattern_type{pattern}, mixture_type{mixture}, unknown_type{material, 0, &RadMaterials::unknown};
    static const std::unordered_map<std::string_view, Type> table = {
        {"plastic", {material, 5, &RadMaterials::plastic}},
        {"plastic2", {material, 6, &RadMaterials::plastic}},
        {"plasfunc", {material, 4, &RadMaterials::plastic}},
        {"plasdata", {material, 4, &RadMaterials::plastic}},
        {"metal", {material, 5, &RadMaterials::metal}},
        {"metal2", {material, 6, &RadMaterials::metal}},
        {"metfunc", {material, 4, &RadMaterials::metal}},
        {"metdata", {material, 4, &RadMaterials::metal}},
        {"trans", {material, 7, &RadMaterials::trans}},
        {"trans2", {material, 8, &RadMaterials::trans}},
        {"transfunc", {material, 6, &RadMaterials::trans}},
        {"transdata", {material, 6, &RadMaterials::trans}},
        {"mirror", {material, 3, &RadMaterials::mirror}},
        {"glass", {material, 3, &RadMaterials::glass}},
        {"dielectric", {material, 5, &RadMaterials::dielectric}},
        {"interface", {material, 8, &RadMaterials::dielectric}},
        {"light", {material, 3, &RadMaterials::light}},
        {"glow", {material, 4, &RadMaterials::light}},
        {"illum", {material, 3, &RadMaterials::light}},
        {"spotlight", {material, 7, &RadMaterials::light}},
        {"mist", {nothing}},
        {"antimatter", {nothing}},
        {"prism1", unknown_type},
        {"prism2", unknown_type},
        {"ashik2", unknown_type},
        {"BRTDfunc", unknown_type},
        {"BSDF", unknown_type},
        {"aBSDF", unknown_type},
        {"WGMDfunc", unknown_type},
        {missing_type, unknown_type},
        {"texfunc", pattern_type},
        {"texdata", pattern_type},
        {"brightfunc", pattern_type},
        {"brightdata", pattern_type},
        {"brighttext", pattern_type},
        {"colorfunc", pattern_type},
        {"colordata", pattern_type},
        {"colorpict", pattern_type},
        {"colortext", pattern_type},
        {"spectrum", pattern_type},
        {"specfile", pattern_type},
        {"specfunc", pattern_type},
        {"specdata", pattern_type},
        {"specpict", pattern_type},
        {"mixfunc", mixture_type},
        {"mixdata", mixture_type},
        {"mixpict", mixture_type},
        {"mixtext", mixture_type},
    };
    return table;
}

bool RadMaterials::is_modifier(std::string_view type) {
    return type == "alias" || (type != missing_type && types().contains(type));
}

std::uint32_t RadMaterials::find(std::string_view name, const Location& where) {
    if (name == "void") return none;
    if (const auto entry = index_.find(name); entry != index_.end()) return entry->second;
    if (!may_miss_)
        throw std::invalid_argument(fmt::format(
            "modifier '{}' is not defined before its use; if another file defines it, give that file first, as "
            "in 'oconv materials.rad room.rad'",
            name));
    Modifier missing{{}, where};
    missing.surface = static_cast<std::uint32_t>(modifiers_.size());
    missing.primitive.type = missing_type;
    missing.primitive.name = missing_names_.emplace_back(name);
    index_.emplace(missing.primitive.name, static_cast<std::uint32_t>(modifiers_.size()));
    modifiers_.push_back(std::move(missing));
    return static_cast<std::uint32_t>(modifiers_.size() - 1);
}

void RadMaterials::define(const RadPrimitive& primitive, const Location& where) {
    Modifier modifier{primitive, where};
    if (primitive.type == "alias") {
        const std::uint32_t original = find(primitive.original, where);
        if (original == none) throw std::invalid_argument("an alias cannot stand for void");
        modifier.primitive = modifiers_[original].primitive;
        modifier.primitive.name = primitive.name;
        if (primitive.modifier == "inherit") modifier.base = modifiers_[original].base;
    }
    if (primitive.modifier != "inherit") modifier.base = find(primitive.modifier, where);
    const Role role = types().at(modifier.primitive.type).role;
    if (role == Role::mixture) {
        // Use the foreground, or the background if the foreground is void
        const auto& strings = modifier.primitive.strings;
        if (strings.size() < 2) throw std::invalid_argument("a mixture needs a foreground and a background");
        modifier.base = find(strings[0], where);
        if (modifier.base == none) modifier.base = find(strings[1], where);
    }
    const auto index = static_cast<std::uint32_t>(modifiers_.size());
    if (role == Role::material || role == Role::nothing)
        modifier.surface = index;
    else if (modifier.base != none)
        modifier.surface = modifiers_[modifier.base].surface;
    index_[primitive.name] = index;
    modifiers_.push_back(std::move(modifier));
}

bool RadMaterials::is_modified_by(std::uint32_t modifier, std::string_view name) const {
    while (modifier != none && modifiers_[modifier].primitive.name != name) modifier = modifiers_[modifier].base;
    return modifier != none;
}

std::optional<RadMaterials::PatternedLight> RadMaterials::patterned_light(std::uint32_t modifier) const {
    if (modifier == none) return std::nullopt;
    const Modifier& light = modifiers_[modifier];
    const Type& type = types().at(light.primitive.type);
    if (type.convert != &RadMaterials::light || light.base == none || light.primitive.numbers.size() < type.numbers)
        return std::nullopt;
    const Modifier& pattern = modifiers_[light.base];
    if (pattern.base != none) return std::nullopt;
    try {
        auto known = parse_light_pattern(pattern.primitive);
        if (!known) return std::nullopt;
        return PatternedLight{std::move(*known), colour_of(light.primitive) * static_cast<float>(rad_efficacy),
                              pattern.where};
    } catch (const std::invalid_argument& fault) {
        throw pattern.where.error(
            fmt::format("{} '{}': {}", pattern.primitive.type, pattern.primitive.name, fault.what()));
    }
}

std::uint32_t RadMaterials::material(std::uint32_t modifier) {
    if (modifier == none) return none;
    const std::uint32_t surface = modifiers_[modifier].surface;
    warn_of_patterns(modifier, surface, to_material);
    if (surface == none) return none;
    Modifier& m = modifiers_[surface];
    const Type& type = types().at(m.primitive.type);
    if (type.role == Role::nothing) {
        warn("unsupported-modifier", fmt::format("faces of the material {} are left out", m.primitive.type), m);
        return none;
    }
    if (m.material != none) return m.material;
    warn_of_patterns(m.base, none, type.convert == &RadMaterials::light ? behind_light : behind_material);
    return m.material = convert(m, type);
}

void RadMaterials::warn_of_patterns(std::uint32_t begin, std::uint32_t end, Chain chain) {
    // The chain ends, because each base is defined before its use.
    for (std::uint32_t i = begin; i != end && !modifiers_[i].has_warned[chain]; i = modifiers_[i].base) {
        modifiers_[i].has_warned[chain] = true;
        warn_of_pattern(modifiers_[i], chain == behind_light);
    }
}

void RadMaterials::warn_of_pattern(const Modifier& modifier, bool is_of_light) {
    const std::string_view type = modifier.primitive.type;
    const Role role = types().at(type).role;
    if (role == Role::pattern && is_of_light)
        warn(
            "unsupported-modifier",
            fmt::format("{} of a light is left out, so the power of the light is probably wrong; place the luminaire's "
                        "photometric file (.ies, .ldt) in its stead",
                        type),
            modifier);
    else if (role == Role::pattern)
        warn("unsupported-modifier", fmt::format("{} is left out, and its modified primitive is used as it is", type),
             modifier);
    if (role == Role::mixture)
        warn("unsupported-modifier", fmt::format("of {} only the foreground is used", type), modifier);
}

std::uint32_t RadMaterials::convert(const Modifier& modifier, const Type& type) {
    const RadPrimitive& p = modifier.primitive;
    Material result;
    result.name = p.name;
    try {
        if (p.numbers.size() < type.numbers)
            throw std::invalid_argument(fmt::format("it has {} numbers; expected {}", p.numbers.size(), type.numbers));
        (this->*type.convert)(modifier, result);
        if (const std::string fault = exitance_fault(result.exitance); !fault.empty())
            throw std::invalid_argument(fault);
    } catch (const std::invalid_argument& fault) {
        throw modifier.where.error(fmt::format("{} '{}': {}", p.type, p.name, fault.what()));
    }
    const bool limited = limit_reflectance(result.reflectance);
    if (limit_sum(result) || limited)
        warn("reflectance-clamped", "more than 0.99 of the light would leave this material: it is reduced", modifier);
    model_.materials.push_back(std::move(result));
    return static_cast<std::uint32_t>(model_.materials.size() - 1);
}

/// Sets the specular reflectance of mirrors, which pictures show. Omits other specular reflection.
void RadMaterials::reflect(const Modifier& modifier, const Rgb& specular, double roughness, Material& result) {
    if (is_mirror(largest_channel(specular), roughness)) result.specular_reflectance = specular;
    if (largest_channel(specular) > 0)
        warn("specular-reflection", "specular reflection is left out, but for mirrors in view of the camera", modifier);
}

void RadMaterials::plastic(const Modifier& modifier, Material& result) {
    const float specular = share(modifier.primitive, 3, "specularity");
    result.reflectance = colour_of(modifier.primitive) * (1 - specular);
    reflect(modifier, Rgb(specular), roughness_of(modifier.primitive), result);
}

void RadMaterials::metal(const Modifier& modifier, Material& result) {
    const float specular = share(modifier.primitive, 3, "specularity");
    const Rgb colour = colour_of(modifier.primitive);
    result.reflectance = colour * (1 - specular);
    reflect(modifier, colour * specular, roughness_of(modifier.primitive), result);
}

void RadMaterials::trans(const Modifier& modifier, Material& result) {
    const RadPrimitive& p = modifier.primitive;
    const float specular = share(p, 3, "specularity");
    const float transmitted = share(p, p.numbers.size() - 2, "transmissivity");
    const float straight = share(p, p.numbers.size() - 1, "transmitted specular component");
    const Rgb rest = colour_of(p) * (1 - specular);
    result.reflectance = rest * (1 - transmitted);
    result.transmittance = rest * transmitted * straight;
    const double roughness = roughness_of(p);
    reflect(modifier, Rgb(specular), roughness, result);
    if (transmitted > 0 && straight < 1) warn("diffuse-transmission", "diffuse transmission is left out", modifier);
    if (transmitted * straight > 0 && roughness > 0)
        warn("rough-transmission", "light goes through without being scattered, whatever the roughness", modifier);
}

void RadMaterials::mirror(const Modifier& modifier, Material& result) {
    reflect(modifier, colour_of(modifier.primitive), 0, result);
}

void RadMaterials::glass(const Modifier& modifier, Material& result) {
    const RadPrimitive& p = modifier.primitive;
    constexpr double usual_index = 1.52;
    const double index = p.numbers.size() > 3 ? p.numbers[3] : usual_index;
    if (!(index > 0))
        throw std::invalid_argument(fmt::format("its index of refraction is {}; expected above 0", index));
    const Rgb transmissivity = colour_of(p);
    for (int c = 0; c < 3; ++c) {
        if (transmissivity[c] > 1)
            throw std::invalid_argument(fmt::format("its transmissivity is {}; expected 0 to 1", transmissivity[c]));
        const GlassShares shares = glass_shares(transmissivity[c], index);
        result.transmittance[c] = static_cast<float>(shares.transmittance);
        result.specular_reflectance[c] = static_cast<float>(shares.reflectance);
    }
}

/// Models one surface, without absorption or refraction.
void RadMaterials::dielectric(const Modifier& modifier, Material& result) {
    const std::vector<double>& numbers = modifier.primitive.numbers;
    const double inside = numbers[3], outside = modifier.primitive.type == "interface" ? numbers[7] : 1;
    if (!(inside > 0 && outside > 0)) throw std::invalid_argument("its indices of refraction must be above 0");
    const double root = (inside - outside) / (inside + outside);
    result.specular_reflectance = Rgb(static_cast<float>(root * root));
    result.transmittance = Rgb(static_cast<float>(1 - root * root));
    warn("refraction", "light passes straight through dielectric and interface, without absorption", modifier);
}

void RadMaterials::light(const Modifier& modifier, Material& result) {
    result.exitance = colour_of(modifier.primitive) * static_cast<float>(std::numbers::pi * rad_efficacy);
    if (modifier.primitive.type == "spotlight")
        warn("spotlight", "spotlight shines diffusely, to all sides, with its radiance", modifier);
}

void RadMaterials::unknown(const Modifier& modifier, Material& result) {
    result.reflectance = Rgb(0.5f);
    const std::string_view type = modifier.primitive.type;
    warn("unsupported-material",
         type == missing_type ? "a material that is not defined, but may be by a command that is left out, is taken as "
                                "diffuse with a reflectance of 0.5"
                              : fmt::format("the material {} is taken as diffuse with a reflectance of 0.5", type),
         modifier);
}

void RadMaterials::warn(const std::string& kind, const std::string& message, const Modifier& modifier) {
    model_.warnings.add(kind, modifier.where.shown(message), modifier.where.text());
}

}  // namespace interflect::detail
