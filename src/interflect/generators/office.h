#pragma once

#include <cstdint>

#include "interflect/scene.h"

namespace interflect::detail {

struct OfficeOptions {
    static constexpr std::uint32_t most_rooms = 256, most_rows = 20, most_desks_per_row = 20;

    std::uint32_t rooms = 1;          ///< 1 to most_rooms.
    std::uint32_t desk_rows = 3;      ///< Per room, 1 to most_rows.
    std::uint32_t desks_per_row = 4;  ///< 1 to most_desks_per_row.
    std::uint64_t seed = 1;           ///< Equal options give equal scenes.
};

/// Creates an office building of one floor: equal rooms, connected by doorways, with parallel rows of desks below a
/// grid of luminaires, and bookcases, cabinets, radiators and pictures along the walls. Other properties as in
/// make_maze(). About 230 patches a desk and 650 a bookcase; one bookcase for every two rows.
///
/// Time and memory are linear in the desks. @throws InputError if an option is out of its range.
Scene make_office(const OfficeOptions& options);

}  // namespace interflect::detail
