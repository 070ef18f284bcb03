#include "interflect/formats/mesh/obj/obj.h"

#include <string>

#include "interflect/formats/mesh/obj/reader.h"
#include "interflect/formats/reading/checked_options.h"
#include "interflect/formats/text/text_file.h"

namespace interflect::detail {

Scene read_obj(const std::filesystem::path& path, const ReadOptions& options) {
    return read_obj_text(read_text_file(path), path, options);
}

Scene read_obj_text(std::string_view text, const std::filesystem::path& path, const ReadOptions& options) {
    require_text(text, path);
    ObjReader reader(path, checked(options));
    reader.read(text);
    return scene_of(reader.finish(), options);
}

}  // namespace interflect::detail
