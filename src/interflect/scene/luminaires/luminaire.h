#pragma once

#include <optional>
#include <variant>

#include "interflect/light_sources.h"

namespace interflect::detail {

/// Returns the position relative to the scene's origin; none for skies and suns.
inline std::optional<V3f> position_of(const Luminaire& luminaire) {
    return std::visit(
        [](const auto& kind) -> std::optional<V3f> {
            if constexpr (requires { kind.position; })
                return kind.position;
            else
                return std::nullopt;
        },
        luminaire.kind);
}

}  // namespace interflect::detail
