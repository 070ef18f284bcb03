#pragma once

#include <cstdint>
#include <string>

#include "interflect/ranks.h"

namespace interflect::detail {

/// Results have equal bits if the program and the instruction set of the processor are equal (libraries use the
/// latter). Other arguments would be ignored, because only the first process reads them.
struct Fingerprint {
    std::uint32_t program;       ///< CRC-32 of the executable file.
    std::uint32_t instructions;  ///< CRC-32 of the processor's flags.
    std::uint32_t arguments;     ///< CRC-32 of the arguments, without the program's name.

    static Fingerprint of_this_process();
};

/// Returns why these processes cannot work on one result, the same text in each, or "". Collective.
std::string difference_among(Ranks& ranks, const Fingerprint& own);

}  // namespace interflect::detail
