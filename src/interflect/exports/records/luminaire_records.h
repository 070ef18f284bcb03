#pragma once

#include <cstddef>
#include <memory>
#include <unordered_map>
#include <vector>

#include "interflect/exports/records/json_text.h"
#include "interflect/light_sources.h"

namespace interflect::detail {

/// Photometric webs of a solution file, in the order of their first use.
class WebTable {
  public:
    std::size_t index_of(const std::shared_ptr<const PhotometricWeb>& web);
    Json json() const;  ///< Value of `photometric_webs` in a solution file.

  private:
    std::vector<std::shared_ptr<const PhotometricWeb>> webs_;
    std::unordered_map<const PhotometricWeb*, std::size_t> index_;
};
/// Inverse of WebTable::json(). @throws Json::exception, std::runtime_error
std::vector<std::shared_ptr<const PhotometricWeb>> webs_of(const Json& json);

/// Images of environment maps, in the order of environment_maps().
using MapImages = std::vector<std::shared_ptr<const Texture>>;

/// Returns the record of a luminaire.
/// @param webs  Receives the luminaire's web.
/// @param maps  Must contain the luminaire's image.
Json json_of(const Luminaire& luminaire, WebTable& webs, const MapImages& maps = {});
/// Inverse of json_of(). @throws Json::exception, std::runtime_error
Luminaire luminaire_of(const Json& json, const std::vector<std::shared_ptr<const PhotometricWeb>>& webs,
                       const MapImages& maps = {});

}  // namespace interflect::detail
