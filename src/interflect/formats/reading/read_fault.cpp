#include "interflect/formats/reading/read_fault.h"

#include <fmt/format.h>

#include "interflect/formats/text/text_file.h"

namespace interflect::detail {

void require_within(const std::filesystem::path& path, const std::filesystem::path& folder, const ReadOptions& options,
                    const std::string& subject) {
    if (!options.outside_files && !is_within(path, folder))
        throw ReadFault(
            fmt::format("{} lies outside the folder of the scene, which is not allowed (outside_files)", subject),
            "outside_files");
}

}  // namespace interflect::detail
