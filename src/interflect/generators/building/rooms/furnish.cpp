#include "interflect/generators/building/rooms/furnish.h"

#include <fmt/format.h>

#include <cmath>

namespace interflect::detail::building {

std::uint32_t Furnisher::add_object(std::string_view name) {
    scene_.objects.push_back(fmt::format("room-{}.{}-{}", room_, name, count_++));
    return static_cast<std::uint32_t>(scene_.objects.size() - 1);
}

void Furnisher::add(const Furniture& piece, const Placement& place) {
    piece.build(Solids(scene_, place, add_object(piece.name)), palette_, random_);
}

void Furnisher::add_luminaires(const Room& room, float ceiling_height, float pitch, bool turned) {
    const auto columns = std::ceil(room.x.length() / pitch), rows = std::ceil(room.y.length() / pitch);
    for (float row = 0; row < rows; ++row)
        for (float column = 0; column < columns; ++column) {
            const V3f middle(room.x.low + room.x.length() * (column + 0.5f) / columns,
                             room.y.low + room.y.length() * (row + 0.5f) / rows, ceiling_height);
            const Placement place = Placement::quarter_turned(middle, turned ? 1 : 0);
            add_luminaire(Solids(scene_, place, add_object("luminaire")), palette_, random_);
        }
}

}  // namespace interflect::detail::building
