#include "interflect/view_factors/write_npz.h"

#include <fmt/format.h>
#include <zip.h>

#include <algorithm>
#include <array>
#include <bit>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace interflect::detail {

namespace {

static_assert(std::endian::native == std::endian::little, "the arrays are written as they are in memory");

template <class T>
constexpr std::string_view type_of;
template <>
constexpr std::string_view type_of<float> = "<f4";
template <>
constexpr std::string_view type_of<double> = "<f8";
template <>
constexpr std::string_view type_of<std::int32_t> = "<i4";
template <>
constexpr std::string_view type_of<std::int64_t> = "<i8";

/// Header of version 1.0 of NumPy's format, padded to a multiple of 64 bytes.
std::string npy_header(std::string_view type, std::string_view shape) {
    constexpr std::size_t prefix = 10, alignment = 64;  // magic, version, length [bytes]
    std::string text = fmt::format("{{'descr': '{}', 'fortran_order': False, 'shape': ({}), }}", type, shape);
    text.resize((prefix + text.size() + 1 + alignment - 1) / alignment * alignment - prefix, ' ');
    text.back() = '\n';
    std::string header = "\x93NUMPY\x01";
    header.push_back('\0');
    header.push_back(static_cast<char>(text.size() & 0xff));
    header.push_back(static_cast<char>(text.size() >> 8));
    return header + text;
}

/// Decodes UTF-8; a byte that belongs to no valid character becomes U+FFFD.
std::u32string code_points(std::string_view text) {
    std::u32string result;
    for (std::size_t i = 0; i < text.size();) {
        const auto first = static_cast<unsigned char>(text[i]);
        // Number of continuation bytes; -1: no character begins with this byte
        const int more = first < 0x80 ? 0 : first >= 0xf0 ? 3 : first >= 0xe0 ? 2 : first >= 0xc0 ? 1 : -1;
        char32_t c = more <= 0 ? first : first & (0x3fu >> more);
        bool is_valid = more >= 0 && i + static_cast<std::size_t>(std::max(more, 0)) < text.size();
        for (int k = 1; is_valid && k <= more; ++k) {
            const auto next = static_cast<unsigned char>(text[i + static_cast<std::size_t>(k)]);
            is_valid = (next & 0xc0) == 0x80;
            c = c << 6 | (next & 0x3fu);
        }
        is_valid = is_valid && c <= 0x10ffff;
        result.push_back(is_valid ? c : 0xfffd);
        i += is_valid ? static_cast<std::size_t>(more) + 1 : 1;
    }
    return result;
}

/// Arrays for one file. libzip reads them when the file is closed, from the memory of the caller.
class NpzFile {
  public:
    explicit NpzFile(const std::filesystem::path& path)
        : path_(path), zip_(zip_open(path.c_str(), ZIP_CREATE | ZIP_TRUNCATE, nullptr)) {
        if (!zip_) fail("cannot be opened");
    }
    ~NpzFile() {
        if (zip_) zip_discard(zip_);
    }
    NpzFile(const NpzFile&) = delete;
    NpzFile& operator=(const NpzFile&) = delete;

    /// @param values  Must outlive commit().
    template <class T>
    void add(const std::string& name, const std::vector<T>& values) {
        add(name, npy_header(type_of<T>, fmt::format("{},", values.size())), values.data(), values.size() * sizeof(T));
    }
    /// Fixed-width characters of 4 bytes, as NumPy's strings.
    void add_names(const std::string& name, const std::vector<std::string>& names) {
        std::vector<std::u32string> decoded;
        std::size_t width = 1;
        for (const std::string& text : names) {
            decoded.push_back(code_points(text));
            width = std::max(width, decoded.back().size());
        }
        for (const std::u32string& text : decoded) {
            characters_ += text;
            characters_.append(width - text.size(), U'\0');
        }
        add(name, npy_header(fmt::format("<U{}", width), fmt::format("{},", names.size())), characters_.data(),
            characters_.size() * sizeof(char32_t));
    }
    void commit() {
        if (zip_close(zip_) != 0) fail(zip_strerror(zip_));
        zip_ = nullptr;
    }

  private:
    [[noreturn]] void fail(std::string_view fault) const {
        throw std::runtime_error(fmt::format("cannot write '{}': {}", path_.string(), fault));
    }

    void add(const std::string& name, std::string header, const void* data, std::size_t bytes) {
        headers_.push_back(std::make_unique<std::string>(std::move(header)));
        const std::array<zip_buffer_fragment_t, 2> parts{
            {{reinterpret_cast<zip_uint8_t*>(headers_.back()->data()), headers_.back()->size()},
             {static_cast<zip_uint8_t*>(const_cast<void*>(data)), bytes}}};  // only read
        zip_source_t* source = zip_source_buffer_fragment(zip_, parts.data(), bytes > 0 ? 2 : 1, 0);
        if (!source) fail(zip_strerror(zip_));
        const zip_int64_t index = zip_file_add(zip_, (name + ".npy").c_str(), source, ZIP_FL_ENC_UTF_8);
        if (index < 0) {
            zip_source_free(source);
            fail(zip_strerror(zip_));
        }
        zip_set_file_compression(zip_, static_cast<zip_uint64_t>(index), ZIP_CM_STORE, 0);
        zip_file_set_mtime(zip_, static_cast<zip_uint64_t>(index), 0, 0);  // no date, so equal results are equal files
    }

    const std::filesystem::path path_;
    zip_t* zip_;
    std::vector<std::unique_ptr<std::string>> headers_;
    std::u32string characters_;
};

void write_arrays(const std::filesystem::path& path, const ViewFactors& f) {
    const auto groups = static_cast<std::int64_t>(f.size());
    const std::vector<std::int64_t> shape{groups, groups}, rays{f.rays_per_group};
    NpzFile npz(path);
    npz.add_names("names", f.names);
    npz.add("areas", f.areas);
    npz.add("shape", shape);
    npz.add("row_offsets", f.row_offsets);
    npz.add("columns", f.columns);
    npz.add("values", f.values);
    npz.add("errors", f.errors);
    npz.add("sky", f.sky);
    npz.add("sky_errors", f.sky_errors);
    npz.add("ground", f.ground);
    npz.add("ground_errors", f.ground_errors);
    npz.add("blocked", f.blocked);
    npz.add("blocked_errors", f.blocked_errors);
    npz.add("rays_per_group", rays);
    npz.commit();
}

}  // namespace

void write_npz(PendingFile& file, const ViewFactors& factors) {
    file.write_by([&](const std::filesystem::path& path) { write_arrays(path, factors); });
    file.commit();
}

}  // namespace interflect::detail
