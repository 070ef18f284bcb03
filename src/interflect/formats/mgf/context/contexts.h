#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "interflect/formats/build/colour.h"
#include "interflect/formats/reading/location.h"
#include "interflect/scene.h"

namespace interflect::detail {

/// Hash table of contexts by their names, whose texts must outlive it.
template <class Context>
class NamedContexts {
  public:
    /// @return  Index, or `none` for an unknown name.
    std::uint32_t find(std::string_view name) const { return slots_[slot_of(name, name_hash(name))].index; }

    Context& operator[](std::uint32_t index) { return entries_[index].context; }

    /// Adds a context, or replaces the context of this name, and returns its index.
    std::uint32_t put(std::string_view name, Context context) {
        const std::uint32_t hash = name_hash(name);
        std::size_t slot = slot_of(name, hash);
        if (slots_[slot].index != none) {
            entries_[slots_[slot].index].context = std::move(context);
            return slots_[slot].index;
        }
        if (2 * (entries_.size() + 1) > slots_.size()) {
            grow();
            slot = slot_of(name, hash);
        }
        slots_[slot] = {hash, static_cast<std::uint32_t>(entries_.size())};
        entries_.push_back({name, std::move(context)});
        return slots_[slot].index;
    }

  private:
    struct Entry {
        std::string_view name;
        Context context;
    };
    struct Slot {
        std::uint32_t hash = 0, index = none;
    };

    static std::uint32_t name_hash(std::string_view name) {
        return static_cast<std::uint32_t>(std::hash<std::string_view>()(name));
    }

    /// Returns the slot of this name, or the free one for it.
    std::size_t slot_of(std::string_view name, std::uint32_t hash) const {
        const std::size_t mask = slots_.size() - 1;
        std::size_t i = hash & mask;
        while (slots_[i].index != none && (slots_[i].hash != hash || entries_[slots_[i].index].name != name))
            i = (i + 1) & mask;
        return i;
    }

    void grow() {
        const std::vector<Slot> old = std::exchange(slots_, std::vector<Slot>(2 * slots_.size()));
        const std::size_t mask = slots_.size() - 1;
        for (const Slot& slot : old) {
            if (slot.index == none) continue;
            std::size_t i = slot.hash & mask;
            while (slots_[i].index != none) i = (i + 1) & mask;
            slots_[i] = slot;
        }
    }

    std::vector<Entry> entries_;
    std::vector<Slot> slots_ = std::vector<Slot>(16);  // a power of two, at most half full
};

/// Table of named contexts, with the current one. Context{} must be MGF's default. The input text must outlive the
/// table.
template <class Context>
class ContextTable {
  public:
    /// @param kind  Kind of context for messages, such as "vertex".
    ContextTable(std::string_view kind, std::size_t max_name_length) : kind_(kind), max_name_length_(max_name_length) {}

    /// The reference is valid until enter().
    Context& current() { return current_ == none ? unnamed_ : named_[current_]; }
    std::string_view current_name() const { return current_name_; }  ///< Empty if unnamed.

    /// The reference is valid until enter().
    Context& find(std::string_view name) { return named_[index_of(name)]; }

    /// Makes a context the current one.
    /// @param words  `name` for an existing context, `name =` for a new one, `name = template` for a copy;
    ///               empty for a new context without a name.
    /// @throws std::invalid_argument
    void enter(std::span<const std::string_view> words) {
        if (words.empty()) {
            unnamed_ = Context{};
            current_ = none;
            current_name_ = {};
            return;
        }
        const std::string_view name = words[0];
        if (words.size() > 1) {
            if (words[1] != "=")
                throw std::invalid_argument(fmt::format("expected '=' after '{}', not '{}'", name, words[1]));
            require_name(name);
            current_ = named_.put(name, words.size() > 2 ? find(words[2]) : Context{});
        } else {
            current_ = index_of(name);
        }
        current_name_ = name;
    }

  private:
    std::uint32_t index_of(std::string_view name) const {
        const std::uint32_t index = named_.find(name);
        if (index == none) throw std::invalid_argument(fmt::format("{} '{}' is not defined", kind_, name));
        return index;
    }

    void require_name(std::string_view name) const {
        if (name.size() > max_name_length_)
            throw std::invalid_argument(
                fmt::format("a name of {} characters; at most {} are read", name.size(), max_name_length_));
        // '-' separates loops; a lone '=' lacks a name.
        if (name[0] == '-' || name == "=") throw std::invalid_argument(fmt::format("'{}' cannot be a name", name));
    }

    std::string_view kind_;
    std::size_t max_name_length_;
    NamedContexts<Context> named_;
    Context unnamed_;
    std::uint32_t current_ = none;  // index in named_; `none` for unnamed_
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
    std::uint32_t scene_index = none;  ///< Index in the scene, once a face outside of all transforms uses the vertex.

    std::optional<V2f> coordinate() const {
        return has_texture_coordinate ? std::optional(texture_coordinate) : std::nullopt;
    }
};

}  // namespace interflect::detail
