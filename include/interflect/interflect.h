/// \file
/// All of the library: read a scene, solve it, look at it, keep it.
#pragma once

#include "interflect/contacts.h"
#include "interflect/denoise.h"
#include "interflect/dimming.h"
#include "interflect/error.h"
#include "interflect/export.h"
#include "interflect/gather.h"
#include "interflect/glare.h"
#include "interflect/image_files.h"
#include "interflect/load_scene.h"
#include "interflect/measure.h"
#include "interflect/measuring_grid.h"
#include "interflect/path_tracer.h"
#include "interflect/photometry.h"
#include "interflect/power_balance.h"
#include "interflect/render.h"
#include "interflect/solution_file.h"
#include "interflect/solver.h"
#include "interflect/tone_map.h"
#include "interflect/validate.h"
