#include "interflect/formats/view_files.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "interflect/base/files/pending_file.h"
#include "interflect/core.h"
#include "interflect/formats/text/json_text.h"
#include "interflect/formats/text/line_reader.h"
#include "interflect/formats/text/number.h"
#include "interflect/formats/text/text_file.h"
#include "interflect/load.h"
#include "interflect/scene/core/view.h"

namespace interflect {

using namespace detail;

namespace fs = std::filesystem;

namespace {

using nlohmann::json;

/// Members of a JSON object. Unknown members are faults.
class Members {
  public:
    Members(const json& object, std::string where, const fs::path& file)
        : object_(object), where_(std::move(where)), file_(file) {
        if (!object.is_object()) fail("expected an object");
    }

    [[noreturn]] void fail(const std::string& message) const { throw InputError(file_, 0, where_ + ": " + message); }

    const json* find(const std::string& key) {
        known_keys_.insert(key);
        const auto member = object_.find(key);
        return member == object_.end() ? nullptr : &*member;
    }
    const json& require(const std::string& key) {
        const json* const member = find(key);
        if (!member) fail(fmt::format("'{}' is missing", key));
        return *member;
    }
    double number(const json& value, const std::string& key) const {
        const double number = value.is_number() ? value.get<double>() : NAN;
        if (!std::isfinite(static_cast<float>(number))) fail(fmt::format("'{}' must be made of finite numbers", key));
        return number;
    }
    Imath::V3d vector(const json& value, const std::string& key) const {
        if (!value.is_array() || value.size() != 3) fail(fmt::format("'{}' must be [x, y, z]", key));
        return {number(value[0], key), number(value[1], key), number(value[2], key)};
    }
    void reject_others() const {
        for (const auto& [key, value] : object_.items())
            if (!known_keys_.contains(key))
                fail(fmt::format("unknown key '{}'; there are {}", key, fmt::join(known_keys_, ", ")));
    }

  private:
    const json& object_;
    std::string where_;
    const fs::path& file_;
    std::set<std::string> known_keys_;
};

View parse_view(const json& value, std::size_t index, const fs::path& path) {
    Members members(value, fmt::format("view {}", index + 1), path);
    View view;
    const json& name = members.require("name");
    if (!name.is_string() || name.get<std::string>().empty()) members.fail("'name' must be a text");
    view.name = name.get<std::string>();
    view.eye = members.vector(members.require("eye"), "eye");
    view.look_at = members.vector(members.require("look_at"), "look_at");
    if (const json* up = members.find("up")) view.up = V3f(members.vector(*up, "up"));
    if (const json* fov = members.find("fov")) view.fov = static_cast<float>(members.number(*fov, "fov"));
    members.reject_others();
    if (const std::string fault = view_fault(view); !fault.empty()) members.fail(fault);
    return view;
}

/// View in the options of Radiance's programs.
class RadianceView {
  public:
    /// Reads an option of rvu with its arguments. Returns the remaining words.
    std::span<const std::string_view> read_option(std::span<const std::string_view> words);
    View view() const {
        View view;
        view.eye = eye_;
        view.look_at = eye_ + direction_;
        view.up = V3f(up_);
        view.fov = static_cast<float>(vertical_);
        return view;
    }

  private:
    using OptionFault = std::invalid_argument;
    Imath::V3d eye_{0, 0, 0}, direction_{0, 1, 0}, up_{0, 0, 1};
    double vertical_ = 45;
};

std::span<const std::string_view> RadianceView::read_option(std::span<const std::string_view> words) {
    const std::string_view option = words[0];
    const auto number = [&](std::size_t i) {
        const auto value = i < words.size() ? parse_number(words[i]) : std::nullopt;
        if (!value) throw OptionFault(fmt::format("{} lacks a finite number", option));
        return *value;
    };
    const auto vector = [&] { return Imath::V3d(number(1), number(2), number(3)); };
    if (option.starts_with("-vt")) {
        if (option != "-vtv")
            throw OptionFault(fmt::format("'{}': only perspective views (-vtv) are understood", option));
        return words.subspan(1);
    }
    if (option == "-vp" || option == "-vd" || option == "-vu") {
        (option == "-vp" ? eye_ : option == "-vd" ? direction_ : up_) = vector();
        return words.subspan(4);
    }
    if (option == "-vv" || option == "-vh") {
        const double degrees = number(1);
        if (option == "-vv") vertical_ = degrees;
        return words.subspan(2);
    }
    if (option == "-vs" || option == "-vl" || option == "-vo" || option == "-va") {
        if (number(1) != 0)
            throw OptionFault(fmt::format("{} must be 0: views have no shift, lift or clipping plane", option));
        return words.subspan(2);
    }
    throw OptionFault(fmt::format("'{}' is no option of a view", option));
}

bool starts_a_view(std::string_view word) { return !word.starts_with('-') && !parse_number(word); }

}  // namespace

fs::path view_list_path(const fs::path& scene_path) { return fs::path(scene_path).replace_extension(".views.json"); }

std::vector<View> detail::read_view_list(const fs::path& path) {
    const json document = parse_json(read_text_file(path), path);
    Members members(document, "the file", path);
    const json& list = members.require("views");
    if (!list.is_array()) members.fail("'views' must be a list");
    members.reject_others();
    std::vector<View> views;
    std::set<std::string> names;
    for (const json& value : list) {
        views.push_back(parse_view(value, views.size(), path));
        if (!names.insert(views.back().name).second)
            throw InputError(path, 0, fmt::format("view {}: a second view '{}'", views.size(), views.back().name));
    }
    return views;
}

void detail::write_view_list(std::span<const View> views, const fs::path& path) {
    // fmt writes the shortest decimals that round-trip.
    const auto vector = [](const auto& v) { return fmt::format("[{}, {}, {}]", v.x, v.y, v.z); };
    std::vector<std::string> lines;
    for (const View& v : views)
        lines.push_back(fmt::format(R"(    {{"name": {}, "eye": {}, "look_at": {}, "up": {}, "fov": {}}})",
                                    json(v.name).dump(), vector(v.eye), vector(v.look_at), vector(v.up), v.fov));
    write_file(path, fmt::format("{{\n  \"views\": [\n{}\n  ]\n}}\n", fmt::join(lines, ",\n")));
}

View read_radiance_view(const fs::path& path) {
    const std::string text = read_text_file(path);
    LineReader lines(text);
    RadianceView radiance_view;
    bool found = false;
    while (lines.next()) try {
            std::span<const std::string_view> words = lines.words();
            // A line may begin with a program name, such as rvu, or with VIEW=.
            if (starts_a_view(words[0])) words = words.subspan(1);
            for (found |= !words.empty(); !words.empty();) words = radiance_view.read_option(words);
        } catch (const std::invalid_argument& fault) {
            throw InputError(path, lines.line(), fault.what());
        }
    if (!found)
        throw InputError(path, 0, "this is no view: expected 'rvu -vtv -vp x y z -vd x y z -vu x y z -vh h -vv v'");
    View view = radiance_view.view();
    view.name = path.stem().string();
    if (const std::string fault = view_fault(view); !fault.empty()) throw InputError(path, 0, fault);
    return view;
}

}  // namespace interflect
