#pragma once

#include <hdf5.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <mutex>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "interflect/exports/hdf5/checksums.h"

namespace interflect::detail {

/// Owns an identifier of HDF5.
class Hdf5Handle {
  public:
    /// @throws std::runtime_error with text `what` for an invalid `id`.
    Hdf5Handle(hid_t id, herr_t (*close)(hid_t), const char* what);
    ~Hdf5Handle() { close_(id_); }
    Hdf5Handle(const Hdf5Handle&) = delete;
    Hdf5Handle& operator=(const Hdf5Handle&) = delete;
    operator hid_t() const { return id_; }

  private:
    hid_t id_;
    herr_t (*close_)(hid_t);
};

/// Excludes other threads while it exists, because HDF5 may not be thread-safe.
class Hdf5Lock {
  public:
    Hdf5Lock() : lock_(mutex()) {}

  private:
    static std::recursive_mutex& mutex();
    std::unique_lock<std::recursive_mutex> lock_;
};

/// Reads arrays of float, double, std::uint32_t, char or std::byte. Refuses arrays that are larger than the file, and
/// data in other files. Throws std::runtime_error.
class Hdf5Reader {
  public:
    explicit Hdf5Reader(const std::filesystem::path& path);
    /// Copies the bytes of Hdf5Writer::image().
    explicit Hdf5Reader(std::span<const char> image);

    bool has(const std::string& name) const;
    /// Reads a two-dimensional array unless `columns` is 1.
    template <class T>
    std::vector<T> read(const std::string& name, std::size_t columns = 1) const;

  private:
    template <class Source>
    Hdf5Reader(Hdf5Lock lock, const Source& source);

    Hdf5Lock lock_;
    Hdf5Handle file_, links_;
};

/// Writes a new HDF5 file; equal contents give equal bytes. Throws std::runtime_error. T is float, double,
/// std::int64_t, std::uint32_t, std::uint8_t or, uncompressed, char.
class Hdf5Writer {
  public:
    /// @param user_block  Number of bytes to reserve at the start of the file.
    Hdf5Writer(const std::filesystem::path& path, std::uint64_t user_block);
    /// Writes a file in memory; image() returns it.
    Hdf5Writer();

    /// Writes an array. @return  Its position in the file.
    template <class T>
    FileRange write(const std::string& name, std::span<const T> numbers, std::size_t columns = 1);
    template <class T>
    void write_compressed(const std::string& name, std::span<const T> numbers, std::size_t columns = 1);
    void write_attribute(const std::string& group, const char* name, std::span<const std::int64_t> numbers);
    void write_attribute(const std::string& group, const char* name, std::string_view text);
    /// Writes the concatenated parts as one array.
    FileRange write_joined(const std::string& name, const std::vector<std::span<const std::byte>>& parts);
    /// Completes the file. Either flush() or image() must be the last call.
    void flush();
    std::string image();

  private:
    Hdf5Lock lock_;
    Hdf5Handle file_;
};

}  // namespace interflect::detail
