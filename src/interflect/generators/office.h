#pragma once

#include <cstdint>

#include "interflect/scene.h"

namespace interflect::detail {

struct OfficeOptions {
    static constexpr std::uint32_t max_rooms = 256, max_rows = 20, max_desks_per_row = 20;

    std::uint32_t rooms = 1;          ///< 1 to max_rooms.
    std::uint32_t desk_rows = 3;      ///< Per room, 1 to max_rows.
    std::uint32_t desks_per_row = 4;  ///< 1 to max_desks_per_row.
    std::uint64_t seed = 1;
};

/// Creates equal rooms with rows of desks, a grid of luminaires and furniture along walls; otherwise as make_maze().
/// @throws InputError for options out of range.
Scene make_office(const OfficeOptions& options);

}  // namespace interflect::detail
