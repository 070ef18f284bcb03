#pragma once

#include <cstddef>
#include <vector>

namespace interflect::inline detail {

/// Half planes of a photometric web as listed in a file, to be completed by symmetry.
class PhotometricPlanes {
  public:
    /// @param angles       Azimuth of each plane [degrees], ascending.
    /// @param intensities  For each plane, one value per polar angle.
    PhotometricPlanes(std::vector<float> angles, std::vector<float> intensities);

    std::size_t count() const { return angles_.size(); }
    float span() const { return angles_.back() - angles_.front(); }  ///< [degrees]
    /// Mirrors all planes at the last or the first one.
    void mirror_at_last();
    void mirror_at_first();
    /// Repeats the first plane one turn later.
    void close();
    /// Reverses the direction of the azimuth.
    void reverse();

    const std::vector<float>& angles() const { return angles_; }
    const std::vector<float>& intensities() const { return intensities_; }
    /// Returns the intensities with polar angle and azimuth exchanged.
    std::vector<float> transposed() const;

  private:
    void append(std::size_t plane, float angle);

    std::vector<float> angles_, intensities_;
    std::size_t height_;  // intensities per plane
};

}  // namespace interflect::inline detail
