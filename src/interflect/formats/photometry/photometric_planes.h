#pragma once

#include <cstddef>
#include <vector>

namespace interflect::detail {

/// Intensities of a photometric file in half planes.
class PhotometricPlanes {
  public:
    /// @param angles  Azimuths [degrees], ascending.
    /// @param intensities  Intensities of each plane in turn, one per polar angle.
    PhotometricPlanes(std::vector<float> angles, std::vector<float> intensities);

    std::size_t count() const { return angles_.size(); }
    float span() const { return angles_.back() - angles_.front(); }  ///< [degrees]
    /// Adds mirror images of all planes beyond the last one.
    void mirror_at_last();
    void mirror_at_first();
    /// Repeats the first plane after a full turn.
    void close();
    /// Negates the angles and reverses the order of planes.
    void reverse();

    const std::vector<float>& angles() const { return angles_; }
    const std::vector<float>& intensities() const { return intensities_; }
    /// Returns the intensities by polar angle, then azimuth.
    std::vector<float> transposed() const;

  private:
    void append(std::size_t plane, float angle);

    std::vector<float> angles_, intensities_;
    std::size_t height_;  // number of intensities per plane
};

}  // namespace interflect::detail
