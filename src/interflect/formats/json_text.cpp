#include "interflect/formats/json_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "interflect/core.h"

namespace interflect::detail {

namespace {

using nlohmann::json;

/// Finds error positions, which some exceptions lack.
class FaultFinder : public nlohmann::json_sax<json> {
  public:
    std::size_t offset() const { return offset_; }

    bool null() override { return true; }
    bool boolean(bool) override { return true; }
    bool number_integer(number_integer_t) override { return true; }
    bool number_unsigned(number_unsigned_t) override { return true; }
    bool number_float(number_float_t, const string_t&) override { return true; }
    bool string(string_t&) override { return true; }
    bool binary(binary_t&) override { return true; }
    bool start_object(std::size_t) override { return true; }
    bool key(string_t&) override { return true; }
    bool end_object() override { return true; }
    bool start_array(std::size_t) override { return true; }
    bool end_array() override { return true; }
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
