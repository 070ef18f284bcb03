#include "interflect/formats/photometry/ldt.h"
#include "tests/fuzz/input/photometric_bytes.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    interflect::read_photometric_bytes(interflect::detail::read_ldt_text, data, size);
    return 0;
}
