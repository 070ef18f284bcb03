#include "interflect/formats/photometry/ldt.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>

#include "interflect/formats/photometry/photometric_planes.h"
#include "interflect/formats/photometry/photometric_text.h"
#include "interflect/formats/text/text_file.h"
#include "interflect/scene/core/web_angles.h"

namespace interflect::detail {

namespace {

namespace fs = std::filesystem;

bool is_start_of_number(char c) { return (c >= '0' && c <= '9') || c == '.' || c == ',' || c == '+' || c == '-'; }

class LdtReader {
  public:
    LdtReader(std::string_view text, const fs::path& path, const ReadOptions& options, Warnings& warnings)
        : path_(path), options_(options), warnings_(warnings), text_(text, path_, "") {}

    PhotometricWeb read();

  private:
    /// Values of Isym.
    enum Symmetry { none_at_all = 0, rotation = 1, c0_plane = 2, c90_plane = 3, both_planes = 4 };

    std::string_view line(const char* what);
    double number_line(const char* what);
    double number_in(std::string_view text, const char* what);
    /// Reads a number, or returns `empty` for an empty line.
    double optional_line(const char* what, double empty);
    double next_number(const std::string& what);
    void skip_ratios();
    std::size_t count_line(const char* what, std::size_t least, std::size_t most);
    void skip_lines(int count);
    void read_opening();
    void read_lamps();
    std::vector<float> angles(std::size_t count, const char* kind, double most);
    std::vector<float> planes_of(const std::vector<float>& all_planes, Symmetry symmetry) const;
    void complete(PhotometricPlanes& planes, Symmetry symmetry) const;
    void warn(const char* kind, const std::string& message) { warnings_.add(kind, message, text_.where()); }

    const fs::path& path_;
    const ReadOptions& options_;
    Warnings& warnings_;
    PhotometricText text_;
    double factor_ = 1;  // factor of intensities
    PhotometricWeb web_;
};

PhotometricWeb LdtReader::read() {
    web_.name = path_.string();
    skip_lines(2);  // manufacturer, type of luminaire
    const auto symmetry = static_cast<Symmetry>(count_line("the symmetry", none_at_all, both_planes));
    const std::size_t most = options_.max_photometric_values;
    const std::size_t plane_count = count_line("the number of C planes", 1, most);
    line("the distance between C planes");
    const std::size_t gamma_count = count_line("the number of intensities in a C plane", 2, most / plane_count);
    line("the distance between intensities");
    skip_lines(8);  // report, name, number, file, date; size of the housing
    read_opening();
    skip_lines(2);  // downward flux, light output ratio
    factor_ = optional_line("the conversion factor", 1);
    if (!(factor_ > 0)) text_.refuse(fmt::format("the conversion factor is {}; expected a number above 0", factor_));
    if (optional_line("the tilt", 0) != 0)
        warn("ldt-tilt", "the luminaire was tilted as it was measured; it is not turned back");
    read_lamps();
    skip_ratios();

    if (symmetry > rotation && plane_count % (symmetry == c0_plane ? 2 : 4) != 0)
        text_.refuse(fmt::format("{} C planes do not have the symmetry {}", plane_count, int{symmetry}));
    const std::vector<float> all_planes = angles(plane_count, "C", full_turn);
    web_.polar = angles(gamma_count, "gamma", half_turn);
    if (std::fmod(web_.polar.front(), right_angle) != 0 || std::fmod(web_.polar.back(), right_angle) != 0)
        warn("ldt-angles", "gamma angles do not reach 0, 90 or 180; beyond them the luminaire emits no light");
    const std::vector<float> measured = planes_of(all_planes, symmetry);
    std::vector<float> intensities;
    for (std::size_t i = 0; i < measured.size() * gamma_count; ++i) {
        const double intensity = next_number("an intensity");
        if (intensity < 0) warn("ldt-negative", "a negative intensity is read as 0");
        intensities.push_back(static_cast<float>(std::max(0.0, intensity) * factor_));
    }
    PhotometricPlanes planes(measured, std::move(intensities));
    complete(planes, symmetry);
    web_.azimuth = planes.angles();
    web_.intensities = planes.intensities();
    if (text_.had_decimal_comma()) warn("ldt-decimal-comma", "decimal commas are read as points");
    if (const std::string fault = web_fault(web_); !fault.empty()) text_.refuse("this luminaire " + fault);
    if (text_.word()) warn("ldt-trailing", "words after the last intensity are ignored");
    return std::move(web_);
}

std::string_view LdtReader::line(const char* what) {
    const auto line = text_.line();
    if (!line) text_.refuse(fmt::format("the file ends before {}", what));
    return *line;
}

double LdtReader::number_line(const char* what) { return number_in(line(what), what); }

/// Reads a number. Words such as its unit may follow.
double LdtReader::number_in(std::string_view text, const char* what) {
    const std::size_t blank = text.find_first_of(" \t");
    if (const auto rest = text.find_first_not_of(" \t", std::min(blank, text.size())); rest != text.npos) {
        if (!is_start_of_number(text[rest])) {
            warn("ldt-comment", "words after a number are ignored");
            text = text.substr(0, blank);
        }
    }
    return text_.number_of(text, what);
}

double LdtReader::optional_line(const char* what, double empty) {
    const std::string_view text = line(what);
    if (!text.empty()) return number_in(text, what);
    warn("ldt-empty", "an empty line in place of a number is read as the usual value");
    return empty;
}

/// Reads the next number. Words may follow the last number of a line.
double LdtReader::next_number(const std::string& what) {
    const std::int64_t line_before = text_.line_number();
    std::optional<std::string_view> word = text_.word();
    while (word && text_.line_number() == line_before && !is_start_of_number(word->front())) {
        warn("ldt-comment", "words after a number are ignored");
        word = text_.word();
    }
    if (!word) text_.refuse(fmt::format("the file ends before {}", what));
    return text_.number_of(*word, what);
}

/// Skips the ten direct ratios. Their lines may be empty or contain several ratios.
void LdtReader::skip_ratios() {
    for (std::size_t left = 10; left > 0;) {
        const std::string_view text = line("a direct ratio");
        std::size_t words = 0;
        for (std::size_t begin = text.find_first_not_of(" \t"); begin != text.npos; ++words)
            begin = text.find_first_not_of(" \t", std::min(text.find_first_of(" \t", begin), text.size()));
        left -= std::clamp<std::size_t>(words, 1, left);
    }
}

std::size_t LdtReader::count_line(const char* what, std::size_t least, std::size_t most) {
    const double value = number_line(what);
    if (!(value >= static_cast<double>(least) && value <= static_cast<double>(most)) || value != std::floor(value))
        text_.refuse(fmt::format("{} is {}; expected a whole number from {} to {}", what, value, least, most));
    return static_cast<std::size_t>(value);
}

void LdtReader::skip_lines(int count) {
    for (int i = 0; i < count; ++i) line("the luminous intensities");
}

/// Reads the luminous opening, whose length is along C90 and whose width is along C0. A width of 0 means a round
/// opening.
void LdtReader::read_opening() {
    constexpr double metres = 1e-3;  // metres per millimetre
    const double length = optional_line("the length of the luminous area", 0),
                 width = optional_line("the width of the luminous area", 0);
    double height = 0;
    for (int side = 0; side < 4; ++side) height = std::max(height, optional_line("the height of the luminous area", 0));
    if (length < 0 || width < 0) text_.refuse("the luminous area has a negative size");
    const bool is_round = width == 0 && length > 0;
    const V3f millimetres(static_cast<float>(is_round ? length : width), static_cast<float>(length),
                          static_cast<float>(height));
    web_.opening = {is_round ? LuminousOpening::Shape::cylinder : LuminousOpening::Shape::box,
                    millimetres * static_cast<float>(metres), 2};
}

/// Reads number, type, flux, colour, colour rendering, power of lamps. A negative number means absolute photometry.
void LdtReader::read_lamps() {
    constexpr std::size_t max_sets = 20;
    const std::size_t sets = count_line("the number of sets of lamps", 1, max_sets);
    if (sets > 1) warn("ldt-lamps", "of several sets of lamps the first is taken");
    for (std::size_t i = 0; i < sets; ++i) {
        const double lamps = optional_line("the number of lamps", 1);
        line("the type of lamp");
        const double lumens = number_line("the flux of the lamps");
        if (!(lumens > 0)) text_.refuse(fmt::format("the flux of the lamps is {} lm; expected more than 0", lumens));
        skip_lines(3);
        if (i > 0) continue;
        constexpr double reference_flux = 1000;  // [lm]
        factor_ *= lumens / reference_flux;
        web_.lamp_lumens = lamps > 0 ? lumens : 0;
    }
}

std::vector<float> LdtReader::angles(std::size_t count, const char* kind, double most) {
    std::vector<float> result;
    for (std::size_t i = 0; i < count; ++i) {
        const double angle = next_number(fmt::format("a {} angle", kind));
        if (angle < 0 || angle > most)
            text_.refuse(fmt::format("a {} angle of {} degrees; expected 0 to {}", kind, angle, most));
        result.push_back(static_cast<float>(angle));
        if (i > 0 && result[i] <= result[i - 1])
            text_.refuse(fmt::format("{} angles must ascend, but {} follows {}", kind, result[i], result[i - 1]));
    }
    return result;
}

/// Returns the angles of the stored planes. Isym 3 stores C270 to C90.
std::vector<float> LdtReader::planes_of(const std::vector<float>& all, Symmetry symmetry) const {
    const std::size_t count = all.size();
    const auto part = [&](std::size_t first, std::size_t end) {
        std::vector<float> angles;
        for (std::size_t i = first; i < end; ++i)
            angles.push_back(all[i % count] + static_cast<float>(i < count ? 0 : full_turn));
        return angles;
    };
    switch (symmetry) {
        case rotation:
            return {0};
        case c0_plane:
            return part(0, count / 2 + 1);
        case c90_plane:
            return part(3 * count / 4, 3 * count / 4 + count / 2 + 1);
        case both_planes:
            return part(0, count / 4 + 1);
        default:
            return all;
    }
}

/// Mirrors the stored planes up to a full turn.
void LdtReader::complete(PhotometricPlanes& planes, Symmetry symmetry) const {
    const auto expected = static_cast<float>(symmetry == both_planes                         ? right_angle
                                             : symmetry == c0_plane || symmetry == c90_plane ? half_turn
                                                                                             : 0);
    const auto quadrant = [](float angle) { return std::fmod(angle, right_angle) == 0; };
    if (expected > 0 && (planes.span() != expected || !quadrant(planes.angles().front())))
        text_.refuse(fmt::format("C planes from {} to {} degrees do not have the symmetry {}", planes.angles().front(),
                                 planes.angles().back(), int{symmetry}));
    if (symmetry == both_planes) planes.mirror_at_last();
    if (expected > 0) planes.mirror_at_last();
    if (planes.span() < static_cast<float>(full_turn)) planes.close();
}

}  // namespace

PhotometricWeb read_ldt(const fs::path& path, const ReadOptions& options, Warnings& warnings) {
    return read_ldt_text(read_photometric_text(path, options), path, options, warnings);
}

PhotometricWeb read_ldt_text(std::string_view text, const fs::path& path, const ReadOptions& options,
                             Warnings& warnings) {
    require_text(text, path);
    return LdtReader(text, path, options, warnings).read();
}

}  // namespace interflect::detail
