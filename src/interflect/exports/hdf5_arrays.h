#pragma once

#include <hdf5.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "interflect/exports/checksums.h"

namespace interflect::inline detail {

/// An HDF5 identifier that closes itself.
class Hdf5Handle {
  public:
    /// @param what  Says what failed where `id` is none. @throws std::runtime_error then.
    Hdf5Handle(hid_t id, herr_t (*close)(hid_t), const char* what);
    ~Hdf5Handle() { close_(id_); }
    Hdf5Handle(const Hdf5Handle&) = delete;
    Hdf5Handle& operator=(const Hdf5Handle&) = delete;
    operator hid_t() const { return id_; }

  private:
    hid_t id_;
    herr_t (*close_)(hid_t);
};

/// The arrays of an HDF5 file, to be read. T is float, double, std::uint32_t, char or std::byte. All functions throw
/// std::runtime_error, and claim no more memory than the file has bytes; arrays in other
/// files (links, external storage, virtual arrays) are refused.
class Hdf5Reader {
  public:
    explicit Hdf5Reader(const std::filesystem::path& path);

    /// Whether there is a group or an array of this name.
    bool has(const std::string& name) const;
    /// An array of one dimension where `columns` is 1, else of two; row by row.
    template <class T>
    std::vector<T> read(const std::string& name, std::size_t columns = 1) const;

  private:
    Hdf5Handle file_, links_;
};

/// A new HDF5 file of arrays, without time stamps, so that equal contents are equal bytes. Types and errors as above;
/// T may be std::int64_t or std::uint8_t, too.
class Hdf5Writer {
  public:
    /// @param user_block  Bytes left free at the beginning of the file.
    Hdf5Writer(const std::filesystem::path& path, std::uint64_t user_block);
    /// A file in memory, whose bytes `image` has.
    Hdf5Writer();

    /// Writes rows of `columns` numbers each. @return Where they are in the file.
    template <class T>
    FileRange write(const std::string& name, std::span<const T> numbers, std::size_t columns = 1);
    /// The same in chunks, each compressed without loss (shuffle and deflate).
    template <class T>
    void write_compressed(const std::string& name, std::span<const T> numbers, std::size_t columns = 1);
    /// Gives the group `group` an attribute: an array of whole numbers, or ASCII text of fixed length.
    void write_attribute(const std::string& group, const char* name, std::span<const std::int64_t> numbers);
    void write_attribute(const std::string& group, const char* name, std::string_view text);
    /// Writes the parts, one after the other, as one array.
    FileRange write_joined(const std::string& name, const std::vector<std::span<const std::byte>>& parts);
    /// To be called last.
    void flush();
    /// The bytes of the file, of one in memory. To be called last.
    std::string image();

  private:
    Hdf5Handle file_;
};

}  // namespace interflect::inline detail
