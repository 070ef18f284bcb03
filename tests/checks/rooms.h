#pragma once

#include <cstdint>
#include <memory>

#include "interflect/scene.h"

namespace interflect::testing_support {

/// A closed, dark room of two-sided faces from (0,0,0) to `size`, each wall divided into 8 x 8 patches.
Scene two_sided_room(V3f size);

/// A closed, dark room of one-sided faces from (0,0,0) to `size`, in walls whose outer side is one-sided too.
Scene thick_walled_room(V3f size, float thickness);

/// Adds a closed box of two-sided faces.
void add_two_sided_box(Scene& scene, V3f low, V3f high, std::uint32_t material = 0);

/// Removes the faces of the ceiling within [low, high] in x and y: whole patches.
void open_ceiling(Scene& scene, V2f low, V2f high);

/// 100 cd in all directions below it.
std::shared_ptr<PhotometricWeb> downlight();

void add_light(Scene& scene, std::shared_ptr<const PhotometricWeb> web, V3f position, V3f direction = {0, 0, -1});

}  // namespace interflect::testing_support
