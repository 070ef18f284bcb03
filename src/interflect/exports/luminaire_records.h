#pragma once

#include <memory>
#include <vector>

#include "interflect/exports/json_text.h"
#include "interflect/luminaire.h"

namespace interflect::inline detail {

/// The photometric webs that luminaires share, in the order in which they are first asked for.
class WebTable {
  public:
    std::size_t index_of(const std::shared_ptr<const PhotometricWeb>& web);
    Json json() const;  ///< Of all, as `photometric_webs` in the description of a solution file.

  private:
    std::vector<std::shared_ptr<const PhotometricWeb>> webs_;
};
/// What WebTable::json() told. @throws Json::exception, std::runtime_error where it is none.
std::vector<std::shared_ptr<const PhotometricWeb>> webs_of(const Json& json);

/// Images of environment maps, in the order of environment_maps().
using MapImages = std::vector<std::shared_ptr<const Texture>>;

/// A luminaire in the description of a solution file. @param webs  Gets the web that it has.
/// @param maps  Among which is its image.
Json json_of(const Luminaire& luminaire, WebTable& webs, const MapImages& maps = {});
/// @throws Json::exception, std::runtime_error where it is none.
Luminaire luminaire_of(const Json& json, const std::vector<std::shared_ptr<const PhotometricWeb>>& webs,
                       const MapImages& maps = {});

}  // namespace interflect::inline detail
