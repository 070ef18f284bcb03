#pragma once

#include "interflect/exports/json_text.h"
#include "interflect/luminaire.h"

namespace interflect::inline detail {

// A luminaire in the description of a solution file.
Json json_of(const Luminaire& luminaire);
/// @throws Json::exception, std::runtime_error where it is none.
Luminaire luminaire_of(const Json& json);

}  // namespace interflect::inline detail
