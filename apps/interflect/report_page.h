#pragma once

#include <optional>
#include <string>
#include <vector>

#include "apps/interflect/measured_grid.h"
#include "apps/interflect/probe_glare.h"
#include "apps/interflect/report_facts.h"
#include "apps/interflect/report_plan.h"
#include "interflect/image.h"
#include "interflect/solution_file.h"

namespace interflect::command {

/// A view of the scene: as it looks, and its illuminance in false colours with their legend.
struct ReportPicture {
    std::string view;
    Image picture, illuminance;  ///< As a display shows them.
};

/// All that a report tells.
struct ReportContent {
    std::string title, date;
    double working_plane = 0;  ///< z in the world [m].
    std::vector<PlanarArea> rooms;
    SceneFacts facts;
    ReportPlan plan;
    std::vector<MeasuredGrid> areas;  ///< The working planes of the rooms come first.
    std::optional<double> exterior;   ///< Illuminance outside, where there are daylight factors [lx].
    std::vector<RatedGrid> glare;     ///< Empty unless asked for.
    std::vector<ReportPicture> pictures;
    int samples = 0, picture_samples = 0;  ///< Gathered directions a measuring point, and a pixel.
};

/// One page of HTML that needs no other file and prints on A4. Names are escaped.
std::string report_page(const ReportContent& content, const SolvedScene& solved);

}  // namespace interflect::command
