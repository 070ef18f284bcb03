// Whatever bytes come in: the EULUMDAT reader returns a web without a fault or throws an InputError.
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string_view>

#include "interflect/error.h"
#include "interflect/formats/ldt.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    interflect::ReadOptions options;
    options.max_photometric_values = 10'000;
    interflect::Warnings warnings;
    try {
        const interflect::PhotometricWeb web =
            interflect::read_ldt_text({reinterpret_cast<const char*>(data), size}, "fuzz.ldt", options, warnings);
        if (const std::string fault = web_fault(web); !fault.empty()) {
            std::fprintf(stderr, "%s\n", fault.c_str());
            std::abort();
        }
        if (!(web.intensity({0.3f, 0.5f, -0.8f}) >= 0) || !(web.flux() > 0)) std::abort();
    } catch (const interflect::InputError&) {
    }
    return 0;
}
