#include "interflect/formats/rad/rad.h"

#include <optional>
#include <string>
#include <utility>

#include "interflect/formats/rad/reader.h"
#include "interflect/formats/reading/checked_options.h"
#include "interflect/formats/text/text_file.h"

namespace interflect::detail {

Scene read_rad(const std::filesystem::path& path, const ReadOptions& options) {
    return read_rad_text(read_text_file(path), path, options);
}

Scene read_rad_text(std::string_view text, const std::filesystem::path& path, const ReadOptions& options) {
    require_text(text, path);
    RadReader reader(path, checked(options));
    reader.read(path, std::string(text));
    for (const std::filesystem::path& further : options.further_files) {
        std::string further_text = read_text_file(further);
        require_text(further_text, further);
        reader.read(further, std::move(further_text));
    }
    const std::optional<Daylight> daylight = reader.daylight();
    Scene scene = scene_of(reader.finish(), options);
    if (daylight) add_daylight(scene, *daylight);
    return scene;
}

}  // namespace interflect::detail
