#include "interflect/exports/records/solve_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <type_traits>
#include <utility>

#include "interflect/core.h"

namespace interflect::detail {

namespace {

template <class Value, std::size_t count>
using Choices = std::array<std::pair<const char*, Value>, count>;

constexpr Choices<PointSet, 2> point_sets{{{"sobol", PointSet::sobol}, {"random", PointSet::random}}};
constexpr Choices<RefinementCriterion, 3> criteria{{{"variance", RefinementCriterion::variance},
                                                    {"perceptual", RefinementCriterion::perceptual},
                                                    {"power", RefinementCriterion::power}}};
constexpr Choices<ImportanceUse, 3> uses_of_importance{
    {{"off", ImportanceUse::off}, {"direct", ImportanceUse::direct}, {"full", ImportanceUse::full}}};

/// Writes the values of for_each_option() or for_each_number() as JSON.
struct Writer {
    Json& json;

    template <class Value>
    void field(const char* name, const Value& value) const {
        json[name] = value;
    }
    template <class Value>
    void field_or_null(const char* name, const Value& value, const Value& when_null) const {
        json[name] = value == when_null ? Json(nullptr) : Json(value);
    }
    void vector(const char* name, const RgbD& value) const { json[name] = json_of(value); }
    template <class Value, std::size_t count>
    void choice(const char* name, const Value& value, const Choices<Value, count>& choices) const {
        for (const auto& [word, meaning] : choices)
            if (meaning == value) json[name] = word;
    }
};

/// Reads a number. All numbers of options and reports must be finite, and non-negative unless `may_be_negative`.
template <class Value>
Value number_of(const Json& json, const char* name, bool may_be_negative = false) {
    const auto require = [&](bool holds) {
        if (!holds) throw std::runtime_error(fmt::format("'{}' is {}, which is out of range", name, json.dump()));
    };
    if constexpr (std::is_same_v<Value, bool>) {
        require(json.is_boolean());
    } else if constexpr (std::is_integral_v<Value>) {
        require(json.is_number_unsigned() || (json.is_number_integer() && json.get<std::int64_t>() >= 0));
        require(json.get<std::uint64_t>() <= static_cast<std::uint64_t>(std::numeric_limits<Value>::max()));
    } else {
        require(json.is_number());
        const double number = json.get<double>();
        constexpr auto most = static_cast<double>(std::numeric_limits<Value>::max());
        require(number >= (may_be_negative ? -most : 0) && number <= most);
    }
    return json.get<Value>();
}

/// Inverse of Writer.
struct Reader {
    const Json& json;
    bool may_be_negative = false;  // whether the caller checks the sign of real numbers

    template <class Value>
    void field(const char* name, Value& value) const {
        value = number_of<Value>(json.at(name), name, may_be_negative);
    }
    template <class Value>
    void field_or_null(const char* name, Value& value, const Value& when_null) const {
        value = json.at(name).is_null() ? when_null : number_of<Value>(json.at(name), name, may_be_negative);
    }
    void vector(const char* name, RgbD& value) const { value = vector_of<RgbD>(json.at(name)); }
    template <class Value, std::size_t count>
    void choice(const char* name, Value& value, const Choices<Value, count>& choices) const {
        const auto found = json.at(name).get<std::string>();
        for (const auto& [word, meaning] : choices)
            if (word == found) {
                value = meaning;
                return;
            }
        throw InputError(fmt::format("option '{}' has an unknown value '{}'", name, found));
    }
};

/// Appends the values of for_each_number() to a row of numbers, and their names.
struct RowWriter {
    std::vector<std::string>& names;
    std::vector<double>& row;

    template <class Value>
    void field(const std::string& name, const Value& value) const {
        names.push_back(name);
        row.push_back(static_cast<double>(value));
    }
    void field_or_null(const char* name, double value, double) const { field(name, value); }
    void vector(const std::string& name, const RgbD& value) const {
        field(name + "_red", value.x);
        field(name + "_green", value.y);
        field(name + "_blue", value.z);
    }
};

/// Inverse of RowWriter.
struct RowReader {
    std::span<const double>& left;  // numbers that are not read yet

    double next(const char* name) const {
        const double number = left.front();
        left = left.subspan(1);
        if (std::isnan(number)) throw std::runtime_error(fmt::format("'{}' of an iteration is not a number", name));
        return number;
    }
    template <class Value>
    void field(const char* name, Value& value) const {
        const double number = next(name);
        constexpr double max_exact = 9007199254740992;  // 2^53
        const double most = std::min(max_exact, static_cast<double>(std::numeric_limits<Value>::max()));
        if (!(number >= 0 && number <= most))
            throw std::runtime_error(fmt::format("'{}' of an iteration is out of range", name));
        value = static_cast<Value>(number);
    }
    void field_or_null(const char* name, double& value, double) const { value = next(name); }
    void vector(const char* name, RgbD& value) const {
        for (int c = 0; c < 3; ++c)
            if (!std::isfinite(value[c] = next(name)))
                throw std::runtime_error(fmt::format("'{}' of an iteration is not finite", name));
    }
};

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Calls `access` with the name and value of each option. Ambiguous names begin with the name of their group.
template <class Options, class Access>
void for_each_option(Options& options, const Access& access) {
    auto& limits = options.limits;
    access.field_or_null("rays", limits.rays, std::numeric_limits<std::int64_t>::max());
    access.field_or_null("time", limits.time, infinity);
    access.field_or_null("until", limits.until, 0.0);
    access.field("keep_direct", options.keep_direct);
    auto& refinement = options.refinement;
    access.choice("refinement_criterion", refinement.criterion, criteria);
    access.field("min_area", refinement.min_area);
    access.choice("importance", options.method.importance, uses_of_importance);
    auto& importance = options.importance;
    access.field("camera_rays", importance.camera_rays);
    access.field("importance_smoothing", importance.smoothing);
    access.field("importance_exponent", importance.exponent);
    auto& o = options.experimental;
    access.choice("points", o.points, point_sets);
    access.field("one_bounce", o.one_bounce);
    access.field("warm_up", o.warm_up);
    access.field("iterations", o.iterations);
    access.field("rays_per_iteration", o.rays_per_iteration);
    access.field("shrinkage", o.shrinkage);
    access.field("clusters", o.clusters);
    access.field("epsilon", o.epsilon);
    access.field("epsilon_decay", o.epsilon_decay);
    access.field("inherited_weight", o.inherited_weight);
    access.field("defer_refinement", o.defer_refinement);
    access.field("separate_iterations", o.separate_iterations);
    access.field("importance_at_patches", o.importance_at_patches);
    access.field("total_importance", o.total_importance);
    access.field("alpha", o.alpha);
    access.field("beta", o.beta);
}

/// Replaces the former names and values of options, and adds missing options.
Json with_present_names(Json json) {
    if (!json.contains("keep_direct")) json["keep_direct"] = false;
    if (!json.contains("clusters")) json["clusters"] = false;
    if (json.contains("time")) return json;
    json["time"] = json.at("seconds");
    json["refinement_criterion"] = json.at("refinement");
    if (json.at("importance") == "none") json["importance"] = "off";
    json["one_bounce"] = !json.at("complete_passes").get<bool>();
    json["separate_iterations"] = json.at("iteration") == "separate";
    json["importance_at_patches"] = json.at("importance_storage") == "patch";
    json["total_importance"] = json.at("importance_sampling") == "total";
    return json;
}

/// Former and present names of the numbers of an iteration.
constexpr std::array<std::pair<const char*, const char*>, 2> renamed_numbers{
    {{"largest_quantum", "largest_payload"}, {"high_quantum", "high_payload"}}};

/// Calls `access` with the name and value of each number of a report.
template <class Report, class Access>
void for_each_number(Report& r, const Access& access) {
    access.field("iteration", r.iteration);
    access.field("rays", r.rays);
    access.field("power_rays", r.power_rays);
    access.field("importance_rays", r.importance_rays);
    access.field("escaped_rays", r.escaped_rays);
    access.field("elements", r.elements);
    access.field("leaves", r.leaves);
    access.vector("total_power", r.total_power);
    access.vector("escaped_power", r.escaped_power);
    access.field_or_null("error_estimate", r.error_estimate, infinity);
    access.field_or_null("noise_estimate", r.noise_estimate, infinity);
    access.field_or_null("discretisation_estimate", r.discretisation_estimate, infinity);
    access.field("largest_payload", r.largest_payload);
    access.field("high_payload", r.high_payload);
}

}  // namespace

Json json_of(const SolveOptions& options) {
    Json json = Json::object();
    for_each_option(options, Writer{json});
    Json& views = json["views"] = Json::array();
    for (const WeightedView& v : options.views) {
        Json& view = views.emplace_back(json_of(v.view));
        view["weight"] = v.weight;
        view["aspect"] = shortest_number(v.aspect);
        view["pixel_rows"] = v.pixel_rows;
    }
    return json;
}

void read_options(const Json& stored, SolveOptions& options, bool may_be_negative) {
    const Json json = with_present_names(stored);
    for_each_option(options, Reader{json, may_be_negative});
    for (const Json& v : json.at("views"))
        options.views.push_back({view_of(v), number_of<double>(v.at("weight"), "weight"),
                                 number_of<float>(v.at("aspect"), "aspect"),
                                 number_of<int>(v.at("pixel_rows"), "pixel_rows")});
}

Json json_of(const IterationReport& report) {
    Json json = Json::object();
    for_each_number(report, Writer{json});
    json["discarded_hits"] = report.discarded_hits;
    return json;
}

IterationReport report_of(const Json& stored) {
    Json json = stored;
    for (const auto& [former, present] : renamed_numbers)
        if (json.contains(former)) json[present] = json.at(former);
    IterationReport report;
    for_each_number(report, Reader{json});
    if (json.contains("discarded_hits"))
        report.discarded_hits = number_of<double>(json.at("discarded_hits"), "discarded_hits");
    return report;
}

std::vector<std::string> report_columns() {
    std::vector<std::string> names;
    std::vector<double> row;
    const IterationReport report;
    for_each_number(report, RowWriter{names, row});
    return names;
}

std::vector<std::string> with_present_columns(std::vector<std::string> columns) {
    for (const auto& [former, present] : renamed_numbers)
        std::replace(columns.begin(), columns.end(), std::string(former), std::string(present));
    return columns;
}

std::vector<double> report_row(const IterationReport& report) {
    std::vector<std::string> names;
    std::vector<double> row;
    for_each_number(report, RowWriter{names, row});
    return row;
}

IterationReport report_of_row(std::span<const double> row) {
    IterationReport report;
    for_each_number(report, RowReader{row});
    return report;
}

Json json_of(const View& view) {
    Json json = {{"name", view.name},
                 {"eye", json_of(view.eye)},
                 {"look_at", json_of(view.look_at)},
                 {"up", json_of(view.up)},
                 {"fov", shortest_number(view.fov)}};
    if (view.extent > 0) json["extent"] = shortest_number(view.extent);
    return json;
}

View view_of(const Json& json) {
    return {json.at("name").get<std::string>(),
            vector_of<Imath::V3d>(json.at("eye")),
            vector_of<Imath::V3d>(json.at("look_at")),
            vector_of<V3f>(json.at("up")),
            json.at("fov").get<float>(),
            json.value("extent", 0.0f)};
}

}  // namespace interflect::detail
