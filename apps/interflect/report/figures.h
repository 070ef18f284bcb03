#pragma once

#include <span>
#include <string>

#include "apps/interflect/measure/measured_grid.h"
#include "apps/interflect/report/plan.h"

namespace interflect::command {

// Figures of a report, as SVG within HTML.

/// Draws the plan with legend, dimensions and a scale bar.
std::string illuminance_figure(const ReportPlan& plan);

/// Draws outlines with the values at measuring points, or with dots if values would be illegible.
std::string values_figure(const ReportPlan& plan, std::span<const MeasuredGrid> areas);

}  // namespace interflect::command
