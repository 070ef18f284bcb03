#pragma once

#include <functional>
#include <iosfwd>
#include <string>
#include <vector>

namespace interflect::testing_support {

/// The text of an IES file, in parts that a test can change.
struct IesText {
    std::string version = "IESNA:LM-63-2002\n[TEST] made here\n";
    std::string tilt = "TILT=NONE\n";
    double lamps = 1, lumens = 1000, multiplier = 1;
    int type = 1, unit = 2;
    std::string opening = "0 0 0";
    double ballast_factor = 1, last_factor = 1;
    std::vector<double> vertical{0, 90}, horizontal{0};
    std::function<double(double, double)> intensity = [](double, double) { return 100; };  ///< (vertical, horizontal).
    std::string line_break = "\n", separator = " ";

    std::string str() const;
};

struct LdtText {
    int symmetry = 0;
    std::vector<double> c{0}, gamma{0, 90};  ///< [degrees]
    double length = 0, width = 0;            ///< Opening [mm].
    double conversion = 1, tilt = 0, lumens = 1000;
    int lamps = 1, lamp_sets = 1;
    std::function<double(double, double)> intensity = [](double, double) { return 100; };  ///< (gamma, C) [cd/klm].
    std::string line_break = "\r\n";

    std::string str() const;  ///< With the planes required by its symmetry.
};

/// A malformed file, and words of the error message.
struct MalformedText {
    std::string name, text, message;
};
std::ostream& operator<<(std::ostream& out, const MalformedText& malformed);

/// Expects that `read` throws an InputError with the message, in a line of the file.
void expect_error(const std::function<void(const std::string& text)>& read, const MalformedText& malformed,
                  const std::string& file);

/// first, first + step, ..., last
std::vector<double> range(double first, double last, double step);

}  // namespace interflect::testing_support
