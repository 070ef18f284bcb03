#pragma once

#include "interflect/scene.h"

namespace interflect::testing_support {

/// Returns a black room of 5 x 4 x 3 m, lit by a sky through a window of 1.5 x 1.2 m in the wall x = 0.
Scene room_with_window(Rgb sky);

}  // namespace interflect::testing_support
