#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "interflect/light_sources.h"
#include "interflect/luminaires/skies/direction_table.h"

namespace interflect::detail {

/// Radiance of a sky dome or environment map.
class SkyRadiance {
  public:
    /// @param dome, map  Without luminaire_fault().
    explicit SkyRadiance(const SkyDome& dome);
    explicit SkyRadiance(const EnvironmentMap& map);

    /// @param direction  Towards the sky, unit length.
    /// @return           [cd/m^2 or W/(m^2 sr)]
    Rgb towards(const V3f& direction) const;
    const SkyFrame& frame() const { return frame_; }

    /// Returns the integral of radiance over each cell: exact for a map, from four points per cell for a dome.
    std::vector<Rgb> cell_integrals(const SkyGrid& grid) const;
    /// Returns the map's texel grid, or cells of 1.4 degrees.
    SkyGrid grid() const;

  private:
    Rgb of_dome(const V3f& direction) const;
    std::vector<Rgb> texel_integrals(const SkyGrid& grid) const;

    SkyFrame frame_;
    SkyModel model_;
    V3f sun_{0, 0, 1};
    Rgb factor_;  // from relative luminance or texel to radiance
    Rgb ground_{0, 0, 0};
    std::shared_ptr<const Texture> image_;  // null: a dome
};

}  // namespace interflect::detail
