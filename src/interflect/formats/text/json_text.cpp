#include "interflect/formats/text/json_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "interflect/core.h"
#include "interflect/formats/text/json_events.h"

namespace interflect::detail {

namespace {

using nlohmann::json;

/// Finds error positions, which some exceptions lack.
class FaultFinder : public JsonEvents<json> {
  public:
    std::size_t offset() const { return offset_; }

    bool parse_error(std::size_t offset, const std::string&, const json::exception&) override {
        offset_ = offset;
        return false;
    }

  private:
    std::size_t offset_ = 0;
};

/// Removes "[json.exception.parse_error.101] ".
std::string_view message_of(const json::exception& error) {
    const std::string_view text = error.what();
    const auto end = text.find("] ");
    return end == text.npos ? text : text.substr(end + 2);
}

}  // namespace

json parse_json(std::string_view text, const std::filesystem::path& path) {
    try {
        return json::parse(text);
    } catch (const json::exception& error) {
        FaultFinder finder;
        json::sax_parse(text, &finder);
        const auto before = text.substr(0, finder.offset());
        throw InputError(path, 1 + std::count(before.begin(), before.end(), '\n'),
                         fmt::format("no valid JSON: {}", message_of(error)));
    }
}

}  // namespace interflect::detail
