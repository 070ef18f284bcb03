#pragma once

#include <array>

#include "interflect/light_sources.h"

namespace interflect::detail {

/// Parameters of a sky model in the order of MGF files and solution files.
inline constexpr std::array<float SkyModel::*, 6> model_parameters = {&SkyModel::a, &SkyModel::b, &SkyModel::c,
                                                                      &SkyModel::d, &SkyModel::e, &SkyModel::g};

}  // namespace interflect::detail
