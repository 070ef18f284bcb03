// Radiance pictures (Ward 1991). stb's reader does not terminate on truncated files.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "interflect/image/codecs/image_codecs.h"

namespace interflect::detail::codecs {

namespace {

using Rgbe = std::array<std::uint8_t, 4>;

constexpr int exponent_bias = 128, mantissa_bits = 8;
/// Widths of scanlines with run-length encoding; others are uncompressed.
constexpr int min_encoded_width = 8, max_encoded_width = 0x7fff;
/// Larger length bytes repeat the next byte (length - longest_literal) times.
constexpr int longest_literal = 128, longest_run = 127;
constexpr int min_run = 4;  // shorter runs are encoded as literals

constexpr float largest_value = 0x1p126f;

/// Returns the colour, clamped to the format's range; magenta if it is not finite.
Rgb representable(const Rgb& colour) {
    if (!is_finite(colour)) return Rgb(largest_value, 0, largest_value);
    Rgb c;
    for (int i = 0; i < 3; ++i) c[i] = std::clamp(colour[i], 0.0f, largest_value);
    return c;
}

Rgbe to_rgbe(const Rgb& colour) {
    const Rgb c = representable(colour);
    int exponent = 0;
    const float mantissa = std::frexp(largest_channel(c), &exponent);  // in [1/2, 1), or 0
    if (mantissa >= 255.5f / 256) ++exponent;                          // its byte would round to 256
    if (mantissa == 0 || exponent <= -exponent_bias) return {0, 0, 0, 0};
    const auto byte = [&](float v) {
        return static_cast<std::uint8_t>(std::lround(std::ldexp(v, mantissa_bits - exponent)));
    };
    return {byte(c.x), byte(c.y), byte(c.z), static_cast<std::uint8_t>(exponent + exponent_bias)};
}

Rgb from_rgbe(const Rgbe& v) {
    if (v[3] == 0) return Rgb(0, 0, 0);
    const float unit = std::ldexp(1.0f, v[3] - exponent_bias - mantissa_bits);
    return Rgb(v[0], v[1], v[2]) * unit;
}

int run_length(const std::vector<Rgbe>& line, int component, int x) {
    int length = 1;
    while (x + length < static_cast<int>(line.size()) && length < longest_run &&
           line[x + length][component] == line[x][component])
        ++length;
    return length;
}

void append_encoded(const std::vector<Rgbe>& line, int component, std::string& file) {
    const int width = static_cast<int>(line.size());
    for (int x = 0; x < width;) {
        const int run = run_length(line, component, x);
        if (run >= min_run) {
            file.push_back(static_cast<char>(longest_literal + run));
            file.push_back(static_cast<char>(line[x][component]));
            x += run;
            continue;
        }
        const int start = x;
        while (x < width && x - start < longest_literal && run_length(line, component, x) < min_run) ++x;
        file.push_back(static_cast<char>(x - start));
        for (int i = start; i < x; ++i) file.push_back(static_cast<char>(line[i][component]));
    }
}

class RadianceReader {
  public:
    explicit RadianceReader(std::string_view bytes) : bytes_(bytes) {}

    std::string_view line() {
        const std::size_t end = bytes_.find('\n', position_);
        if (end == std::string_view::npos) throw std::runtime_error("it ends within its header");
        const std::string_view text = bytes_.substr(position_, end - position_);
        position_ = end + 1;
        return text;
    }
    std::uint8_t byte() {
        if (position_ >= bytes_.size()) throw std::runtime_error("it ends too early");
        return static_cast<std::uint8_t>(bytes_[position_++]);
    }
    Rgbe pixel() {
        Rgbe v;
        for (auto& component : v) component = byte();
        return v;
    }
    bool at_encoded_line(std::size_t width) const {
        const auto at = [&](std::size_t i) {
            return position_ + i < bytes_.size() ? static_cast<std::uint8_t>(bytes_[position_ + i]) : 0xff;
        };
        return at(0) == 2 && at(1) == 2 && (static_cast<std::size_t>(at(2)) << 8 | at(3)) == width;
    }
    std::size_t bytes_left() const { return bytes_.size() - position_; }

  private:
    std::string_view bytes_;
    std::size_t position_ = 0;
};

struct Size {
    int width, height;
};

/// Returns the line in quotes if it is a resolution. Other lines may be content of arbitrary files.
std::string shown(std::string_view resolution) {
    const bool is_one = resolution.find_first_not_of("+-XY 0123456789") == resolution.npos;
    return is_one ? fmt::format("'{}'", resolution) : "none";
}

/// Parses '-Y height +X width', the only supported order.
Size parse_resolution(std::string_view line) {
    Size size{0, 0};
    const char* end = line.data() + line.size();
    // Returns the end of the number, or end + 1 for a fault
    const auto number = [&](std::string_view label, const char* from, int& value) {
        if (!std::string_view(from, static_cast<std::size_t>(end - from)).starts_with(label)) return end + 1;
        const auto [after, error] = std::from_chars(from + label.size(), end, value);
        return error == std::errc() ? after : end + 1;
    };
    const char* middle = number("-Y ", line.data(), size.height);
    if (middle > end || number(" +X ", middle, size.width) != end)
        throw std::runtime_error(fmt::format("its resolution is {}, expected '-Y height +X width'", shown(line)));
    return size;
}

bool is_exposure(std::string_view text) {
    text.remove_prefix(std::min(text.find_first_not_of(' '), text.size()));
    if (text.starts_with('+')) text.remove_prefix(1);
    float factor = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), factor);
    return error == std::errc() && factor > 0 && std::isfinite(factor);
}

/// Checks the header. The exposure is ignored, because the pixels already contain it.
void read_header(RadianceReader& reader) {
    constexpr std::string_view format = "FORMAT=", exposure = "EXPOSURE=";
    if (!reader.line().starts_with("#?")) throw std::runtime_error("it does not begin with '#?RADIANCE'");
    for (std::string_view line = reader.line(); !line.empty(); line = reader.line()) {
        if (line.starts_with(format) && line.substr(format.size()) != "32-bit_rle_rgbe")
            throw std::runtime_error(
                fmt::format("its format is {}, expected '32-bit_rle_rgbe'",
                            line.substr(format.size()) == "32-bit_rle_xyze" ? "'32-bit_rle_xyze'" : "another"));
        if (line.starts_with(exposure) && !is_exposure(line.substr(exposure.size())))
            throw std::runtime_error("its EXPOSURE is no number above 0");
    }
}

void read_encoded_line(RadianceReader& reader, std::vector<Rgbe>& line) {
    reader.pixel();
    for (int component = 0; component < 4; ++component)
        for (std::size_t x = 0; x < line.size();) {
            const int code = reader.byte();
            const bool run = code > longest_literal;
            const auto length = static_cast<std::size_t>(run ? code - longest_literal : code);
            if (length > line.size() - x) throw std::runtime_error("a run of pixels leaves its row");
            const std::uint8_t repeated = run ? reader.byte() : std::uint8_t{0};
            for (std::size_t i = 0; i < length; ++i) line[x++][component] = run ? repeated : reader.byte();
        }
}

}  // namespace

std::string encode_radiance(const Image& image) {
    std::string file = fmt::format("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {} +X {}\n", image.height, image.width);
    const bool encoded = image.width >= min_encoded_width && image.width <= max_encoded_width;
    std::vector<Rgbe> line(image.width);
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) line[x] = to_rgbe(image.at(x, y));
        if (encoded) {
            for (const int marker : {2, 2, image.width >> 8, image.width & 0xff})
                file.push_back(static_cast<char>(marker));
            for (int component = 0; component < 4; ++component) append_encoded(line, component, file);
        } else {
            for (const Rgbe& pixel : line) file.append(reinterpret_cast<const char*>(pixel.data()), pixel.size());
        }
    }
    return file;
}

Image decode_radiance(std::string_view bytes, std::int64_t max_pixels) {
    RadianceReader reader(bytes);
    read_header(reader);
    const Size size = parse_resolution(reader.line());
    require_allowed_size(size.width, size.height, max_pixels);
    // Run-length encoding takes at least eight bytes for 127 pixels.
    const std::int64_t min_bytes = std::int64_t{size.width} * size.height / 16;
    if (static_cast<std::int64_t>(reader.bytes_left()) < min_bytes) throw std::runtime_error("it ends too early");

    Image image(size.width, size.height);
    std::vector<Rgbe> line(size.width);
    for (int y = 0; y < size.height; ++y) {
        if (reader.at_encoded_line(line.size()))
            read_encoded_line(reader, line);
        else
            for (Rgbe& pixel : line) pixel = reader.pixel();
        for (int x = 0; x < size.width; ++x) image.at(x, y) = from_rgbe(line[x]);
    }
    return image;
}

}  // namespace interflect::detail::codecs
