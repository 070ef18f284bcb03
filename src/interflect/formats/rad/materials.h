#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "interflect/formats/build/model.h"
#include "interflect/formats/rad/statements/light_pattern.h"
#include "interflect/formats/rad/statements/statements.h"
#include "interflect/formats/reading/location.h"

namespace interflect::detail {

/// Factor from radiometric values of Radiance to photometric ones [lm/W].
inline constexpr double rad_efficacy = 179;

struct GlassShares {
    double transmittance = 0, reflectance = 0;
};
/// Returns the shares of a pane at normal incidence, with all internal reflections.
/// @param transmissivity  Transmittance of the interior in one pass, 0 to 1. @param index  Refractive index, > 0.
GlassShares glass_shares(double transmissivity, double index);

/// Modifiers of a scene. Converts those in use to materials; unused ones cause no errors or warnings.
class RadMaterials {
  public:
    explicit RadMaterials(Model& model) : model_(model) {}

    static bool is_modifier(std::string_view type);
    /// Hides earlier modifiers of the same name. @throws std::invalid_argument
    void define(const RadPrimitive& primitive, const Location& where);

    /// Makes undefined modifiers grey: ignored commands may define them.
    void allow_missing() { may_miss_ = true; }

    /// @return  `none` for "void". @throws std::invalid_argument if undefined.
    std::uint32_t find(std::string_view name, const Location& where);
    /// Returns whether `name` is the modifier, or modifies it.
    bool is_modified_by(std::uint32_t modifier, std::string_view name) const;
    /// Light with a pattern of ies2rad.
    struct PatternedLight {
        RadLightPattern pattern;
        Rgb radiance;    ///< Radiance before the pattern [lm/(m^2 sr)].
        Location where;  ///< Place of the pattern.
    };
    /// Returns the light of `modifier` if a pattern of ies2rad alone modifies it.
    std::optional<PatternedLight> patterned_light(std::uint32_t modifier) const;
    /// Returns an index into Model::materials; `none` if invisible. @throws InputError
    std::uint32_t material(std::uint32_t modifier);

  private:
    struct Modifier {
        RadPrimitive primitive;
        Location where;
        std::uint32_t base = none;         // modifier of this one
        std::uint32_t material = none;     // index, once used
        std::uint32_t surface = none;      // this one or its first base that is a material
        std::array<bool, 3> has_warned{};  // one per Chain; includes all modifiers beyond
    };
    /// Parts of a surface's chain of modifiers: up to its material, and beyond a material or light.
    enum Chain : std::uint8_t { to_material, behind_material, behind_light };
    enum class Role { material, pattern, mixture, nothing };
    struct Type {
        Role role;
        std::size_t numbers = 0;  // minimum count
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
    void warn_of_pattern(const Modifier& modifier, bool is_of_light);
    /// Warns about ignored patterns. Visits each modifier once per kind of chain.
    void warn_of_patterns(std::uint32_t begin, std::uint32_t end, Chain chain);
    void warn(const std::string& kind, const std::string& message, const Modifier& modifier);

    Model& model_;
    bool may_miss_ = false;
    std::deque<std::string> missing_names_;  // string_views refer to these
    std::vector<Modifier> modifiers_;
    std::unordered_map<std::string_view, std::uint32_t> index_;  // index of the latest modifier of each name
};

}  // namespace interflect::detail
