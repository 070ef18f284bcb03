#include "interflect/base/numbers/random.h"

#include <Random123/philox.h>

namespace interflect::detail {

std::array<std::uint32_t, 4> random_words(std::uint64_t key, std::uint64_t index) {
    const r123::Philox4x32::key_type k = {{static_cast<std::uint32_t>(key), static_cast<std::uint32_t>(key >> 32)}};
    const r123::Philox4x32::ctr_type c = {
        {static_cast<std::uint32_t>(index), static_cast<std::uint32_t>(index >> 32), 0, 0}};
    const r123::Philox4x32::ctr_type words = r123::Philox4x32()(c, k);
    return {words[0], words[1], words[2], words[3]};
}

double random_double(std::uint64_t key, std::uint64_t index) {
    const auto words = random_words(key, index);
    const std::uint64_t bits = (std::uint64_t{words[0]} << 32 | words[1]) >> 11;
    return static_cast<double>(bits) * 0x1p-53;
}

}  // namespace interflect::detail
