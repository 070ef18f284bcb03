#pragma once

#include <span>
#include <string>

#include "apps/interflect/measured_grid.h"
#include "apps/interflect/report_plan.h"

namespace interflect::command {

// Figures of a report, as SVG within HTML.

/// Draws the plan in false colours with its legend, dimensions and a scale bar.
std::string illuminance_figure(const ReportPlan& plan);

/// Draws the plan's outlines with the values at measuring points, or dots if the values would be illegible.
std::string values_figure(const ReportPlan& plan, std::span<const MeasuredGrid> areas);

}  // namespace interflect::command
