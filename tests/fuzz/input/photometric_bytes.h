#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "interflect/core.h"
#include "interflect/formats/photometry/ies.h"

namespace interflect {

/// For arbitrary bytes, a photometry reader returns a faultless web or throws an InputError.
inline void read_photometric_bytes(decltype(detail::read_ies_text)& read, const std::uint8_t* data, std::size_t size) {
    ReadOptions options;
    options.max_photometric_values = 10'000;
    Warnings warnings;
    try {
        const PhotometricWeb web = read({reinterpret_cast<const char*>(data), size}, "fuzz.ies", options, warnings);
        if (const std::string fault = web_fault(web); !fault.empty()) {
            std::fprintf(stderr, "%s\n", fault.c_str());
            std::abort();
        }
        if (!(web.intensity({0.3f, 0.5f, -0.8f}) >= 0) || !(web.flux() > 0)) std::abort();
    } catch (const InputError&) {
    }
}

}  // namespace interflect
