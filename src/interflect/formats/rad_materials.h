#pragma once

#include <cstdint>
#include <deque>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "interflect/formats/location.h"
#include "interflect/formats/model.h"
#include "interflect/formats/rad_statements.h"

namespace interflect::inline detail {

/// Luminous efficacy that Radiance assumes of white light [lm/W]: its radiances are in W/(m^2 sr).
inline constexpr double rad_efficacy = 179;

/// The share of light that a pane of glass lets through at normal incidence, and the share that it mirrors, after all
/// reflections within it. @param transmissivity  What of the light is left after one way through, in [0, 1]. @param
/// index  Of refraction, > 0.
struct GlassShares {
    double transmittance = 0, reflectance = 0;
};
GlassShares glass_shares(double transmissivity, double index);

/// The modifiers of a Radiance scene, and the materials that they stand for. Only what a surface uses is converted, and
/// only there are its faults and warnings told.
class RadMaterials {
  public:
    /// @param model  Gets the materials and the warnings.
    explicit RadMaterials(Model& model) : model_(model) {}

    /// Whether `type` is one of a modifier.
    static bool is_modifier(std::string_view type);
    /// Adds a modifier, which hides an earlier one of that name. @throws std::invalid_argument
    void define(const RadPrimitive& primitive, const Location& where);

    /// From now on, modifiers that are not defined are taken as diffuse grey, with a warning: a command that was left
    /// out may define them.
    void allow_missing() { may_miss_ = true; }

    /// Index of the modifier with this name; none for `void`. @throws std::invalid_argument  where it is not defined
    std::uint32_t find(std::string_view name, const Location& where);
    /// Index in Model::materials of what a surface with this modifier shows; none where that is nothing.
    /// @throws InputError  with the place of the modifier that has a fault
    std::uint32_t material(std::uint32_t modifier);

  private:
    struct Modifier {
        RadPrimitive primitive;
        Location where;
        std::uint32_t base = none;      // the modifier that it modifies
        std::uint32_t material = none;  // index in Model::materials, once a surface has used it
    };
    enum class Role { material, pattern, mixture, nothing };
    struct Type {
        Role role;
        std::size_t numbers = 0;  // the fewest that it has
        void (RadMaterials::*convert)(const Modifier&, Material&) = nullptr;
    };
    static const std::unordered_map<std::string_view, Type>& types();

    std::uint32_t convert(const Modifier& modifier, const Type& type);
    void plastic(const Modifier& modifier, Material& result);
    void metal(const Modifier& modifier, Material& result);
    void trans(const Modifier& modifier, Material& result);
    void mirror(const Modifier& modifier, Material& result);
    void glass(const Modifier& modifier, Material& result);
    void dielectric(const Modifier& modifier, Material& result);
    void light(const Modifier& modifier, Material& result);
    void unknown(const Modifier& modifier, Material& result);
    void reflect(const Modifier& modifier, const Rgb& specular, double roughness, Material& result);
    void warn_of_pattern(const Modifier& modifier);
    void warn(const std::string& kind, const std::string& message, const Modifier& modifier);

    Model& model_;
    bool may_miss_ = false;
    std::deque<std::string> missing_names_;  // which views point to
    std::vector<Modifier> modifiers_;
    std::unordered_map<std::string_view, std::uint32_t> index_;  // of the latest with each name
};

}  // namespace interflect::inline detail
