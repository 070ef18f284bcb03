#pragma once

#include <filesystem>
#include <string_view>

#include "interflect/core.h"
#include "interflect/light_sources.h"
#include "interflect/load.h"

namespace interflect::detail {

/// Reads EULUMDAT (Stockmar 1990; docs/light/luminaires.md). @throws InputError
PhotometricWeb read_ldt(const std::filesystem::path& path, const ReadOptions& options, Warnings& warnings);

PhotometricWeb read_ldt_text(std::string_view text, const std::filesystem::path& path, const ReadOptions& options,
                             Warnings& warnings);

}  // namespace interflect::detail
