#pragma once

#include <cstdint>

#include "interflect/scene.h"

namespace interflect::inline detail {

struct OfficeOptions {
    static constexpr std::uint32_t most_rooms = 256, most_rows = 20, most_desks_per_row = 20;

    std::uint32_t rooms = 1;          ///< 1 to most_rooms.
    std::uint32_t desk_rows = 3;      ///< In each room, 1 to most_rows.
    std::uint32_t desks_per_row = 4;  ///< 1 to most_desks_per_row.
    std::uint64_t seed = 1;           ///< Same options, same scene.
};

/// An office building of one floor: equal rooms, joined by doorways, in which desks stand in rows behind each other,
/// all the same way round, below a grid of luminaires; along the walls bookcases, cabinets, radiators, pictures.
/// Otherwise as make_maze(): closed, one-sided, about the origin, the same names of objects and views. About 230
/// patches a desk and 650 a bookcase, of which there is one for every two rows.
///
/// Time and memory are linear in the desks. @throws InputError where an option is out of its range.
Scene make_office(const OfficeOptions& options);

}  // namespace interflect::inline detail
