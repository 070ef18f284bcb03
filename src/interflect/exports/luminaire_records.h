#pragma once

#include <memory>
#include <vector>

#include "interflect/exports/json_text.h"
#include "interflect/luminaire.h"

namespace interflect::inline detail {

/// Photometric webs shared by luminaires, in order of first use.
class WebTable {
  public:
    std::size_t index_of(const std::shared_ptr<const PhotometricWeb>& web);
    Json json() const;  ///< All webs, as `photometric_webs` in the description of a solution file.

  private:
    std::vector<std::shared_ptr<const PhotometricWeb>> webs_;
};
/// Parses WebTable::json(). @throws Json::exception, std::runtime_error if it is invalid.
std::vector<std::shared_ptr<const PhotometricWeb>> webs_of(const Json& json);

/// Images of environment maps, in the order of environment_maps().
using MapImages = std::vector<std::shared_ptr<const Texture>>;

/// Describes a luminaire for a solution file. @param webs  Receives its web.
/// @param maps  Must contain its image.
Json json_of(const Luminaire& luminaire, WebTable& webs, const MapImages& maps = {});
/// Parses a luminaire. @throws Json::exception, std::runtime_error if it is invalid.
Luminaire luminaire_of(const Json& json, const std::vector<std::shared_ptr<const PhotometricWeb>>& webs,
                       const MapImages& maps = {});

}  // namespace interflect::inline detail
