#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "interflect/image.h"

namespace interflect::detail {

/// Intel Open Image Denoise 2, loaded at run time.
class Oidn {
  public:
    /// @param file  The library, or its name for the dynamic linker.
    /// @throws std::runtime_error if it cannot be loaded, is another library, or has another version than 2.
    explicit Oidn(const std::filesystem::path& file);
    ~Oidn();
    Oidn(const Oidn&) = delete;
    Oidn& operator=(const Oidn&) = delete;

    const std::filesystem::path& file() const { return file_; }
    /// Returns the version, such as "2.5.1".
    const std::string& version() const { return version_; }

  private:
    friend class OidnFilter;
    struct Functions;
    std::filesystem::path file_;
    std::unique_ptr<Functions> functions_;
    std::string version_;
};

/// Result of the search for the library.
struct FoundOidn {
    std::shared_ptr<const Oidn> library;  ///< Null if none can be used.
    std::string fault;                    ///< Reason why no library can be used.
};

/// Searches INTERFLECT_OIDN alone if it is set; otherwise the libraries of the system, then the Python package pyoidn
/// in the folder of `scripts/setup denoiser` and in the active virtual environment. Loads the library once per process.
FoundOidn find_oidn();

/// Filter of pictures of linear light, all with the same surfaces.
class OidnFilter {
  public:
    /// @param albedo  Reflectance of the visible surfaces, in [0, 1], without noise.
    /// @param normal  Normals of the visible surfaces, towards the camera.
    OidnFilter(std::shared_ptr<const Oidn> library, Image albedo, Image normal);

    /// @param light  Non-negative; finite.
    /// @return       The same bits for any number of threads on one kind of processor.
    /// @throws std::runtime_error with the message of the library.
    Image operator()(const Image& light) const;

  private:
    void require_success() const;

    std::shared_ptr<const Oidn> library_;
    Image albedo_, normal_;
    using Handle = std::unique_ptr<void, void (*)(void*)>;
    Handle device_{nullptr, nullptr}, filter_{nullptr, nullptr};
};

}  // namespace interflect::detail
