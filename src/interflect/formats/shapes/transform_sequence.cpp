#include "interflect/formats/shapes/transform_sequence.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

#include "interflect/formats/text/number.h"

namespace interflect::detail {

namespace {

using Imath::M44d;
using Imath::V3d;

/// Arguments of options, which are read one after the other. Errors name the option.
class Arguments {
    std::span<const std::string_view> words_;
    std::string_view option_;

    template <class Parse>
    auto convert(const Parse& parse, const char* expected) {
        if (words_.empty()) throw std::invalid_argument(fmt::format("{} lacks {}", option_, expected));
        const auto value = parse(words_.front());
        if (!value)
            throw std::invalid_argument(fmt::format("{} needs {}, not '{}'", option_, expected, words_.front()));
        words_ = words_.subspan(1);
        return *value;
    }

  public:
    explicit Arguments(std::span<const std::string_view> words) : words_(words) {}

    bool empty() const { return words_.empty(); }
    std::string_view option() {
        option_ = words_.front();
        words_ = words_.subspan(1);
        return option_;
    }
    double number() { return convert(parse_number, "a finite number"); }
    int count() {
        const int n = convert(parse_integer, "a whole number");
        if (n < 0) throw std::invalid_argument(fmt::format("{} cannot take the negative number {}", option_, n));
        return n;
    }
};

struct SineCosine {
    double sine, cosine;
};

/// Returns exact values for quarter turns, so that rotated copies meet.
SineCosine sine_cosine(double degrees) {
    const double reduced = std::remainder(degrees, 360.0);
    if (reduced == 0) return {0, 1};
    if (reduced == 90) return {1, 0};
    if (reduced == -90) return {-1, 0};
    if (std::abs(reduced) == 180) return {0, -1};
    const double radians = reduced * std::numbers::pi / 180;
    return {std::sin(radians), std::cos(radians)};
}

/// Returns a right-handed rotation about a coordinate axis.
M44d rotation(int axis, double degrees) {
    const auto [sine, cosine] = sine_cosine(degrees);
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    M44d m;
    m[u][u] = m[v][v] = cosine;
    m[u][v] = sine;
    m[v][u] = -sine;
    return m;
}

M44d scaling(const V3d& factors) {
    M44d m;
    m.setScale(factors);
    return m;
}

M44d mirror(int axis) {
    V3d factors(1);
    factors[axis] = -1;
    return scaling(factors);
}

M44d elementary(std::string_view option, Arguments& arguments) {
    if (option == "-t") {
        const double x = arguments.number(), y = arguments.number(), z = arguments.number();
        M44d m;
        m.setTranslation(V3d(x, y, z));
        return m;
    }
    if (option == "-s") {
        const double factor = arguments.number();
        if (factor == 0) throw std::invalid_argument("-s cannot scale by 0");
        return scaling(V3d(factor));
    }
    for (int axis = 0; axis < 3; ++axis) {
        const char name = "xyz"[axis];
        if (option == std::string{'-', 'r', name}) return rotation(axis, arguments.number());
        if (option == std::string{'-', 'm', name}) return mirror(axis);
    }
    throw std::invalid_argument(fmt::format(
        "'{}' is no transform; there are -t x y z, -rx -ry -rz degrees, -s factor, -mx -my -mz, -i N, -a N", option));
}

/// Squares repeatedly: files may request a billion repetitions.
M44d power(M44d base, int exponent) {
    M44d result;
    for (; exponent > 0; exponent /= 2, base = base * base)
        if (exponent % 2) result = result * base;
    return result;
}

}  // namespace

TransformSequence::TransformSequence(std::span<const std::string_view> arguments) {
    segments_.emplace_back();
    for (Arguments rest(arguments); !rest.empty();) {
        const std::string_view option = rest.option();
        if (option == "-i") {
            segments_.push_back({M44d(), rest.count(), false});
        } else if (option == "-a") {
            const int copies = rest.count();
            if (copies == 0) throw std::invalid_argument("-a needs at least one copy");
            array_sizes_.push_back(copies);
            segments_.push_back({M44d(), 0, true});
        } else {
            segments_.back().step = segments_.back().step * elementary(option, rest);
        }
    }
}

M44d TransformSequence::matrix(std::span<const int> copy) const {
    M44d result;
    std::size_t array = 0;
    for (const Segment& segment : segments_)
        result = result * power(segment.step, segment.is_array ? copy[array++] : segment.repetitions);
    return result;
}

bool next_index(std::vector<int>& copy, std::span<const int> sizes) {
    for (std::size_t i = copy.size(); i-- > 0;) {
        if (++copy[i] < sizes[i]) return true;
        copy[i] = 0;
    }
    return false;
}

}  // namespace interflect::detail
