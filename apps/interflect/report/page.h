#pragma once

#include <optional>
#include <string>
#include <vector>

#include "apps/interflect/measure/measured_grid.h"
#include "apps/interflect/measure/probe_glare.h"
#include "apps/interflect/report/facts.h"
#include "apps/interflect/report/plan.h"
#include "interflect/image.h"
#include "interflect/solution.h"

namespace interflect::command {

struct ReportPicture {
    std::string view;
    Image picture, illuminance;  ///< Images in display values.
};

struct ReportContent {
    std::string title, date;
    double working_plane = 0;  ///< z in the world [m].
    std::vector<PlanarArea> rooms;
    SceneFacts facts;
    ReportPlan plan;
    std::vector<MeasuredGrid> areas;  ///< Begins with the working planes of the rooms.
    std::optional<double> exterior;   ///< Exterior illuminance for daylight factors [lx].
    std::vector<RatedGrid> glare;     ///< Empty unless requested.
    std::vector<ReportPicture> pictures;
    int samples = 0, picture_samples = 0;  ///< Gathered directions per measuring point, and per pixel.
};

/// Returns a self-contained page for A4 with escaped names.
std::string report_page(const ReportContent& content, const SolvedScene& solved);

}  // namespace interflect::command
