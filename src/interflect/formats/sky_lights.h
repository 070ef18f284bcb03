#pragma once

#include <filesystem>
#include <memory>

#include "interflect/luminaire.h"

namespace interflect::inline detail {

/// Reads the image of an environment map. @throws InputError with the path and the reason.
std::shared_ptr<const Texture> read_environment(const std::filesystem::path& path);

}  // namespace interflect::inline detail
