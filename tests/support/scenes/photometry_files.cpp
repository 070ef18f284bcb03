#include "tests/support/scenes/photometry_files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <ostream>
#include <sstream>

#include "interflect/core.h"

namespace interflect::testing_support {

std::string IesText::str() const {
    std::ostringstream text;
    text << version << tilt;
    const auto put = [&](auto... values) { ((text << values << separator), ...); };
    put(lamps, lumens, multiplier, vertical.size(), horizontal.size(), type, unit, opening);
    text << line_break;
    put(ballast_factor, last_factor, 50);
    text << line_break;
    for (const double v : vertical) put(v);
    text << line_break;
    for (const double h : horizontal) put(h);
    text << line_break;
    for (const double h : horizontal) {
        for (const double v : vertical) put(intensity(v, h));
        text << line_break;
    }
    return text.str();
}

std::string LdtText::str() const {
    std::ostringstream text;
    const auto put = [&](auto... values) { ((text << values << line_break), ...); };
    put("a maker", 1, symmetry, c.size(), 0, gamma.size(), 0, "report", "name", "number", "file", "date");
    put(100, 100, 100, length, width, 0, 0, 0, 0, 100, 100, conversion, tilt, lamp_sets);
    for (int i = 0; i < lamp_sets; ++i) put(lamps, "a lamp", lumens, "840", "1B", 36);
    for (int i = 0; i < 10; ++i) put(0.5);
    for (const double angle : c) put(angle);
    for (const double angle : gamma) put(angle);
    const std::size_t n = c.size();
    const std::size_t first = symmetry == 3 ? 3 * n / 4 : 0, count = symmetry == 0   ? n
                                                                     : symmetry == 1 ? 1
                                                                     : symmetry == 4 ? n / 4 + 1
                                                                                     : n / 2 + 1;
    for (std::size_t i = first; i < first + count; ++i)
        for (const double g : gamma) put(intensity(g, c[i % n]));
    return text.str();
}

std::ostream& operator<<(std::ostream& out, const MalformedText& malformed) { return out << malformed.name; }

void expect_error(const std::function<void(const std::string& text)>& read, const MalformedText& malformed,
                  const std::string& file) {
    try {
        read(malformed.text);
        ADD_FAILURE() << malformed.text;
    } catch (const InputError& e) {
        EXPECT_THAT(e.what(), testing::HasSubstr(file + ":"));
        EXPECT_THAT(e.what(), testing::HasSubstr(malformed.message));
    }
}

std::vector<double> range(double first, double last, double step) {
    std::vector<double> values;
    for (int i = 0; first + i * step <= last; ++i) values.push_back(first + i * step);
    return values;
}

}  // namespace interflect::testing_support
