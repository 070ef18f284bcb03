#include "interflect/formats/reading/source_files.h"

#include <stdexcept>
#include <system_error>
#include <utility>

#include "interflect/core.h"
#include "interflect/formats/text/text_file.h"

namespace interflect::detail {

namespace fs = std::filesystem;

std::pair<const SourceFile&, bool> SourceFiles::add(const fs::path& path, std::string&& text) {
    std::error_code ignored;  // an error leaves the path empty
    const auto [source, is_new] =
        sources_.try_emplace(fs::weakly_canonical(path, ignored), SourceFile{path, std::move(text)});
    source_of_path_.emplace(path.string(), &source->second);
    return {source->second, is_new};
}

std::pair<const SourceFile&, bool> SourceFiles::find(std::string_view name, const SourceFile& includer) {
    const fs::path path = includer.path.parent_path() / name;
    const auto known = source_of_path_.find(path.string());
    if (known != source_of_path_.end()) return {*known->second, false};
    try {
        return add(path, read_text_file(path));
    } catch (const InputError& unreadable) {
        throw std::invalid_argument(unreadable.what());
    }
}

}  // namespace interflect::detail
