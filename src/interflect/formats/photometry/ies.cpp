#include "interflect/formats/photometry/ies.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "interflect/core.h"
#include "interflect/formats/photometry/photometric_planes.h"
#include "interflect/formats/photometry/photometric_text.h"
#include "interflect/formats/reading/read_fault.h"
#include "interflect/formats/text/number.h"
#include "interflect/formats/text/text_file.h"
#include "interflect/scene/core/web_angles.h"

namespace interflect::detail {

namespace {

namespace fs = std::filesystem;

/// Years of LM-63: the first edition, the last edition with a ballast-lamp photometric factor, and the edition that
/// reserves this number for future use.
constexpr int first_year = 1986, last_year_of_factor = 1995, year_of_reserved = 2002;

/// Sizes of the luminous opening [m]. The length is along C0; sizes across a round section are negative.
struct Dimensions {
    double width, length, height;
};

std::string upper_case(std::string_view text) {
    std::string result(text);
    for (char& c : result)
        if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
    return result;
}

std::string_view trimmed(std::string_view text) {
    while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
    return text;
}

std::optional<std::string_view> tilt_of(std::string_view line) {
    constexpr std::string_view keyword = "TILT";
    if (!upper_case(line.substr(0, keyword.size())).starts_with(keyword)) return std::nullopt;
    line = trimmed(line.substr(keyword.size()));
    return line.starts_with('=') ? std::optional(trimmed(line.substr(1))) : std::nullopt;
}

/// Returns the shape of an opening. Three negative sizes mean an ellipsoid, two a cylinder along the third axis. Until
/// LM-63-1995, one negative size means a circle if another is 0, a negative height and one other negative size an
/// ellipsoid, or a sphere if the third is 0.
LuminousOpening opening_of(const Dimensions& d, int year, bool& is_known) {
    using Shape = LuminousOpening::Shape;
    const bool round[3] = {d.length < 0, d.width < 0, d.height < 0};
    const int round_count = round[0] + round[1] + round[2];
    V3f size(static_cast<float>(std::abs(d.length)), static_cast<float>(std::abs(d.width)),
             static_cast<float>(std::abs(d.height)));
    is_known = true;
    if (round_count == 0) return {Shape::box, size, 2};
    if (round_count == 3) return {Shape::ellipsoid, size, 2};
    if (round_count == 2 && round[2]) {
        float& third = round[0] ? size.y : size.x;
        const bool is_sphere = third == 0;
        if (is_sphere) third = round[0] ? size.x : size.y;
        if (is_sphere || year <= last_year_of_factor) return {Shape::ellipsoid, size, 2};
    }
    if (round_count == 2) return {Shape::cylinder, size, round[0] ? (round[1] ? 2 : 1) : 0};
    if (!round[2]) {
        if (size.x == 0 || size.y == 0) size.x = size.y = std::max(size.x, size.y);
        return {Shape::cylinder, size, 2};
    }
    if (size.y == 0) {
        size.y = size.z;
        return {Shape::cylinder, size, 0};
    }
    if (size.x == 0) {
        size.x = size.z;
        return {Shape::cylinder, size, 1};
    }
    is_known = false;
    return {Shape::box, size, 2};
}

class IesReader {
  public:
    IesReader(std::string_view text, const fs::path& path, const fs::path& folder, const ReadOptions& options,
              Warnings& warnings)
        : path_(path), folder_(folder), options_(options), warnings_(warnings), text_(text, path_, ",") {}

    PhotometricWeb read();

  private:
    enum Type { type_c = 1, type_b = 2, type_a = 3 };  // the numbers in LM-63 files

    void read_labels();
    void read_version(std::string_view first_line);
    void read_tilt(std::string_view tilt);
    double tilt_factor(PhotometricText& text);
    void read_photometry();
    double positive(const char* what);
    void read_opening(double metres);
    void warn_of_unit(const Dimensions& d, double metres);
    std::vector<float> angles(std::size_t count, const char* kind, float low, float high);
    void read_type_c(std::vector<float> vertical, std::vector<float> horizontal);
    void read_type_a_or_b(std::vector<float> vertical, std::vector<float> horizontal, Type type);
    PhotometricPlanes planes(std::vector<float> horizontal, std::size_t vertical_count);
    void warn(const char* kind, const std::string& message) { warnings_.add(kind, message, text_.where()); }

    const fs::path& path_;
    const fs::path& folder_;  // folder of the TILT file
    const ReadOptions& options_;
    Warnings& warnings_;
    PhotometricText text_;
    int year_ = first_year;
    double factor_ = 1;  // factor of intensities
    PhotometricWeb web_;
};

PhotometricWeb IesReader::read() {
    web_.name = path_.string();
    read_labels();
    read_photometry();
    if (text_.word()) warn("ies-trailing", "words after the last intensity are ignored");
    if (const std::string fault = web_fault(web_); !fault.empty()) text_.refuse("this luminaire " + fault);
    return std::move(web_);
}

void IesReader::read_labels() {
    for (bool is_first = true;; is_first = false) {
        const auto line = text_.line();
        if (!line) text_.refuse("expected a line that begins with TILT=, as all files after IES LM-63 have");
        if (is_first) read_version(*line);
        if (const auto tilt = tilt_of(*line)) return read_tilt(*tilt);
    }
}

/// Accepts versions such as "IESNA91", "IESNA:LM-63-1995", "IES:LM-63-2019". Files of 1986 begin with labels.
void IesReader::read_version(std::string_view first_line) {
    const std::string line = upper_case(first_line);
    if (!line.starts_with("IES")) return;
    constexpr std::string_view standard = "LM-63-";
    constexpr int year_of_short_name = 1991, nineteenth = 1900, twentieth = 2000, two_digits = 100;
    const auto begin = line.find(standard);
    int year = line == "IESNA91" ? year_of_short_name : -1;
    if (begin != line.npos) year = parse_integer(line.substr(begin + standard.size())).value_or(-1);
    if (year >= 0 && year < two_digits) year += nineteenth + year >= first_year ? nineteenth : twentieth;
    if (year >= first_year)
        year_ = year;
    else
        warn("ies-version", fmt::format("'{}' is no known version of IES LM-63; it is read as that of {}",
                                        first_line.substr(0, options_.max_name_length), year_ = last_year_of_factor));
}

void IesReader::read_tilt(std::string_view tilt) {
    const std::string kind = upper_case(tilt);
    if (kind == "NONE") return;
    if (kind == "INCLUDE") {
        factor_ *= tilt_factor(text_);
        return;
    }
    if (tilt.empty()) text_.refuse("expected TILT=NONE, TILT=INCLUDE or TILT=FILE");
    if (options_.max_include_depth < 1) text_.refuse("no other file may be read (max_include_depth is 0)");
    const fs::path path = folder_ / tilt;
    try {
        require_within(path, folder_, options_, fmt::format("the TILT file '{}'", path.string()));
    } catch (const ReadFault& fault) {
        text_.refuse(fault.what(), fault.setting);
    }
    std::string content;
    try {
        content = read_photometric_text(path, options_);
    } catch (const InputError& unreadable) {
        text_.refuse(fmt::format("the TILT file {}", unreadable.what()));
    }
    PhotometricText text(content, path, ",");
    try {
        factor_ *= tilt_factor(text);
    } catch (const InputError&) {  // its message quotes the file
        text_.refuse(
            fmt::format("the TILT file {} has no TILT data: expected the lamp's geometry (1 to 3), the number of "
                        "angles, the angles, and the same number of factors of at least 0",
                        text.where()));
    }
}

/// Returns the factor at tilt 0, the position of the measurement.
double IesReader::tilt_factor(PhotometricText& text) {
    text.count("the lamp's geometry in TILT data", 1, 3);
    const std::size_t count = text.count("the number of TILT angles", 1, options_.max_photometric_values);
    const std::vector<double> angles = text.numbers(count, "a TILT angle");
    const std::vector<double> factors = text.numbers(count, "a TILT factor");
    if (!std::is_sorted(angles.begin(), angles.end())) text.refuse("TILT angles must ascend");
    if (*std::min_element(factors.begin(), factors.end()) < 0) text.refuse("a TILT factor must not be negative");
    if (std::any_of(factors.begin(), factors.end(), [](double f) { return f != 1; }))
        warn("ies-tilt", "TILT factors are ignored, except for the position in which the luminaire was measured");
    const auto above = static_cast<std::size_t>(std::upper_bound(angles.begin(), angles.end(), 0) - angles.begin());
    if (above == 0 || above == count) return factors[above == 0 ? 0 : count - 1];
    const double share = -angles[above - 1] / (angles[above] - angles[above - 1]);
    return factors[above - 1] + share * (factors[above] - factors[above - 1]);
}

double IesReader::positive(const char* what) {
    const double value = text_.number(what);
    if (!(value > 0)) text_.refuse(fmt::format("{} is {}; expected a number above 0", what, value));
    return value;
}

void IesReader::read_photometry() {
    constexpr double feet = 0.3048;  // [m]
    const double lamps = positive("the number of lamps"), lumens = text_.number("the lumens of a lamp");
    if (lumens <= 0 && lumens != -1)
        warn("ies-lumens", "the lumens of a lamp are neither positive nor -1, and read as -1: absolute photometry");
    web_.lamp_lumens = lumens > 0 ? lamps * lumens : 0;
    factor_ *= positive("the multiplier");
    const std::size_t most = options_.max_photometric_values;
    const std::size_t vertical_count = text_.count("the number of vertical angles", 2, most);
    const std::size_t horizontal_count = text_.count("the number of horizontal angles", 1, most / vertical_count);
    const auto type = static_cast<Type>(text_.count("the photometric type", type_c, type_a));
    read_opening(text_.count("the unit of length", 1, 2) == 1 ? feet : 1);
    factor_ *= positive("the ballast factor");
    const double last_factor = positive("the ballast-lamp photometric factor");
    if (year_ <= last_year_of_factor)
        factor_ *= last_factor;
    else if (year_ == year_of_reserved && last_factor != 1)
        warn("ies-reserved", "a number that IES LM-63-2002 reserves for future use is not 1; it is ignored");
    text_.number("the input power");
    const bool is_c = type == type_c;
    constexpr auto half_circle = static_cast<float>(half_turn);
    // Read the angles, whose limits depend on the type
    auto vertical = angles(vertical_count, "vertical",
                           is_c             ? 0
                           : type == type_a ? -right_angle
                                            : -half_circle,
                           is_c             ? half_circle
                           : type == type_a ? right_angle
                                            : half_circle);
    auto horizontal = angles(horizontal_count, "horizontal",
                             is_c             ? -2 * half_circle
                             : type == type_a ? -half_circle
                                              : -right_angle,
                             is_c             ? 2 * half_circle
                             : type == type_a ? half_circle
                                              : right_angle);
    if (is_c)
        read_type_c(std::move(vertical), std::move(horizontal));
    else
        read_type_a_or_b(std::move(vertical), std::move(horizontal), type);
}

void IesReader::read_opening(double metres) {
    const std::vector<double> sizes = text_.numbers(3, "a size of the luminous opening");
    bool is_known = false;
    web_.opening = opening_of({sizes[0] * metres, sizes[1] * metres, sizes[2] * metres}, year_, is_known);
    if (!is_known) warn("ies-opening", "the luminous opening has no shape of IES LM-63; it is read as a box");
    warn_of_unit({sizes[0], sizes[1], sizes[2]}, metres);
}

/// Warns about sizes too large for luminaires, and about feet if width and length match metric ceiling grids.
void IesReader::warn_of_unit(const Dimensions& d, double metres) {
    constexpr double largest = 10;  // [m]
    const double longest = std::max({std::abs(d.width), std::abs(d.length), std::abs(d.height)});
    if (longest * metres > largest)
        warn("ies-unit",
             fmt::format("the luminous opening is {:g} m long: the file may be in another unit", longest * metres));
    const auto is_module = [](double size) {
        // Least and largest sizes of luminaires in ceiling grids [m]
        constexpr std::pair<double, double> modules[] = {{0.295, 0.3}, {0.595, 0.6}, {0.62, 0.625}, {1.195, 1.2}};
        constexpr double rounding = 1e-6;
        return std::any_of(std::begin(modules), std::end(modules), [&](const auto& module) {
            return size >= module.first - rounding && size <= module.second + rounding;
        });
    };
    if (metres != 1 && is_module(d.width) && is_module(d.length) && std::max(d.width, d.length) > 0.5)
        warn(
            "ies-unit",
            fmt::format("the luminous opening of {:g} x {:g} is read in feet, as the file says, but is a usual size in "
                        "metres",
                        d.width, d.length));
}

/// Reads angles. Rounds angles close to a multiple of 90 degrees, for exact tests of symmetry.
std::vector<float> IesReader::angles(std::size_t count, const char* kind, float low, float high) {
    constexpr float tolerance = 0.01f;  // [degrees]
    std::vector<float> result;
    for (std::size_t i = 0; i < count; ++i) {
        auto angle = static_cast<float>(text_.number(fmt::format("a {} angle", kind)));
        const float quadrant = right_angle * std::round(angle / right_angle);
        if (std::abs(angle - quadrant) < tolerance) angle = quadrant;
        if (angle < low || angle > high)
            text_.refuse(fmt::format("a {} angle of {} degrees; expected {} to {}", kind, angle, low, high));
        if (!result.empty() && angle <= result.back())
            text_.refuse(fmt::format("{} angles must ascend, but {} follows {}", kind, angle, result.back()));
        result.push_back(angle);
    }
    return result;
}

PhotometricPlanes IesReader::planes(std::vector<float> horizontal, std::size_t vertical_count) {
    std::vector<float> intensities;
    for (std::size_t i = 0; i < horizontal.size() * vertical_count; ++i) {
        const double candela = text_.number("an intensity");
        if (candela < 0) warn("ies-negative", "a negative intensity is read as 0");
        intensities.push_back(static_cast<float>(std::max(0.0, candela) * factor_));
    }
    return {std::move(horizontal), std::move(intensities)};
}

/// Reads intensities of type C. Mirrors ranges of 90 and 180 degrees.
void IesReader::read_type_c(std::vector<float> vertical, std::vector<float> horizontal) {
    constexpr auto half_circle = static_cast<float>(half_turn), turn = static_cast<float>(full_turn);
    const bool is_complete = (vertical.front() == 0 || vertical.front() == right_angle) &&
                             (vertical.back() == right_angle || vertical.back() == half_circle);
    if (!is_complete)
        warn("ies-angles", "vertical angles do not reach 0, 90 or 180; beyond them the luminaire emits no light");
    const float first = horizontal.front(), span = horizontal.back() - first;
    const float step = horizontal.size() > 1 ? span / static_cast<float>(horizontal.size() - 1) : 0;
    // The last plane of an open range is about one step before a full turn.
    const bool is_open = span > half_circle && span < turn && span + 1.5f * step > turn;
    const bool is_single = horizontal.size() == 1;
    if (!is_single && !is_open &&
        (std::fmod(first, right_angle) != 0 || std::fmod(span, right_angle) != 0 || span == half_circle + right_angle ||
         span > turn))
        text_.refuse(fmt::format("horizontal angles from {} to {}; expected 0, or 0 to 90, 180 or 360, or 90 to 270",
                                 first, horizontal.back()));
    PhotometricPlanes all = planes(std::move(horizontal), vertical.size());
    if (is_open) warn("ies-angles", "horizontal angles end before 360; there the first plane is repeated");
    if (span == right_angle) all.mirror_at_last();
    if (all.span() == half_circle) all.mirror_at_last();
    if (is_single || is_open) all.close();
    web_.polar = std::move(vertical);
    web_.azimuth = all.angles();
    web_.intensities = all.intensities();
}

/// Reads intensities of type A or B. Mirrors ranges that begin at 0. Type A has clockwise angles and its pole at the
/// nadir; type B has its pole at C90.
void IesReader::read_type_a_or_b(std::vector<float> vertical, std::vector<float> horizontal, Type type) {
    if (horizontal.size() < 2) text_.refuse("a single horizontal angle; expected at least two of types A and B");
    if (std::abs(vertical.back()) < right_angle || std::abs(horizontal.back()) < right_angle)
        warn("ies-angles", "angles do not reach 90 degrees; beyond them the luminaire emits no light");
    const bool is_symmetric = horizontal.front() == 0;
    PhotometricPlanes all = planes(std::move(horizontal), vertical.size());
    if (is_symmetric) all.mirror_at_first();
    if (vertical.front() == 0) {
        warn("ies-symmetry",
             "vertical angles of type A or B begin at 0, for which IES LM-63 has no rule; the other half is taken as "
             "its mirror image");
        PhotometricPlanes by_vertical(std::move(vertical), all.transposed());
        by_vertical.mirror_at_first();
        all = PhotometricPlanes(all.angles(), by_vertical.transposed());
        vertical = by_vertical.angles();
    }
    if (type == type_a) {
        all.reverse();
        for (float& angle : vertical) angle += right_angle;
        web_.polar = std::move(vertical);
        web_.azimuth = all.angles();
        web_.intensities = all.intensities();
    } else {
        web_.pole = PhotometricWeb::Pole::c90;
        for (const float angle : all.angles()) web_.polar.push_back(angle + right_angle);
        web_.azimuth = std::move(vertical);
        web_.intensities = all.transposed();
    }
}

}  // namespace

PhotometricWeb read_ies(const fs::path& path, const ReadOptions& options, Warnings& warnings) {
    return read_ies_text(read_photometric_text(path, options), path, options, warnings);
}

PhotometricWeb read_ies_text(std::string_view text, const fs::path& path, const ReadOptions& options,
                             Warnings& warnings) {
    return read_enclosed_ies(text, path, path.parent_path(), options, warnings);
}

PhotometricWeb read_enclosed_ies(std::string_view text, const fs::path& name, const fs::path& folder,
                                 const ReadOptions& options, Warnings& warnings) {
    require_text(text, name);
    return IesReader(text, name, folder, options, warnings).read();
}

}  // namespace interflect::detail
