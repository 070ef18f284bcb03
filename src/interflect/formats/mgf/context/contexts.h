#pragma once

#include <fmt/format.h>

#include <filesystem>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <unordered_map>

#include "interflect/formats/build/colour.h"
#include "interflect/formats/reading/location.h"
#include "interflect/scene.h"

namespace interflect::detail {

/// Table of named contexts, with the current one. Context{} must be MGF's default. The input text must outlive the
/// table.
template <class Context>
class ContextTable {
  public:
    /// @param kind  Kind of context for messages, such as "vertex".
    ContextTable(std::string_view kind, std::size_t max_name_length) : kind_(kind), max_name_length_(max_name_length) {}

    Context& current() { return *current_; }
    std::string_view current_name() const { return current_name_; }  ///< Empty if unnamed.

    Context& find(std::string_view name) {
        const auto entry = named_.find(name);
        if (entry == named_.end()) throw std::invalid_argument(fmt::format("{} '{}' is not defined", kind_, name));
        return entry->second;
    }

    /// Makes a context the current one.
    /// @param words  `name` for an existing context, `name =` for a new one, `name = template` for a copy;
    ///               empty for a new context without a name.
    /// @throws std::invalid_argument
    void enter(std::span<const std::string_view> words) {
        if (words.empty()) {
            unnamed_ = Context{};
            current_ = &unnamed_;
            current_name_ = {};
            return;
        }
        const std::string_view name = words[0];
        if (words.size() > 1) {
            if (words[1] != "=")
                throw std::invalid_argument(fmt::format("expected '=' after '{}', not '{}'", name, words[1]));
            require_name(name);
            Context content = words.size() > 2 ? find(words[2]) : Context{};
            named_.insert_or_assign(name, std::move(content));
        }
        current_ = &find(name);
        current_name_ = name;
    }

  private:
    void require_name(std::string_view name) const {
        if (name.size() > max_name_length_)
            throw std::invalid_argument(
                fmt::format("a name of {} characters; at most {} are read", name.size(), max_name_length_));
        // '-' separates loops; a lone '=' lacks a name.
        if (name[0] == '-' || name == "=") throw std::invalid_argument(fmt::format("'{}' cannot be a name", name));
    }

    std::string_view kind_;
    std::size_t max_name_length_;
    std::unordered_map<std::string_view, Context> named_;
    Context unnamed_;
    Context* current_ = &unnamed_;  // points to an element of the table, which does not move
    std::string_view current_name_;
};

struct MgfColour {
    Chromaticity chromaticity;
    std::uint32_t fault = none;  ///< Index in MgfFaults, or none.
};

struct MgfTexture {
    std::string path;
    Location where;
};

/// Reflectances and transmittances are luminous, 0 to 1.
struct MgfMaterial {
    bool two_sided = true;
    double rd = 0, td = 0, rs = 0, ts = 0;
    double ed = 0;  ///< [lm/m^2]
    double rs_roughness = 0, ts_roughness = 0;
    MgfColour rd_colour, rs_colour, ts_colour, ed_colour;
    MgfTexture rd_texture, ts_texture, ed_texture;
    Location defined;                  ///< Place of the last change.
    std::uint32_t fault = none;        ///< Index in MgfFaults, or none.
    std::uint32_t scene_index = none;  ///< Index in the scene, once the material is used.

    bool is_textured() const {
        return !(rd_texture.path.empty() && ts_texture.path.empty() && ed_texture.path.empty());
    }
};

struct MgfVertex {
    Imath::V3d point{0, 0, 0};
    Imath::V3d normal{0, 0, 0};  ///< Unit length; 0 if absent.
    bool has_texture_coordinate = false;
    V2f texture_coordinate{0, 0};

    std::optional<V2f> coordinate() const {
        return has_texture_coordinate ? std::optional(texture_coordinate) : std::nullopt;
    }
};

}  // namespace interflect::detail
