#pragma once

#include <span>
#include <string>

#include "apps/interflect/measured_grid.h"
#include "apps/interflect/report_plan.h"

namespace interflect::command {

// Figures of a report, as SVG within HTML.

/// The plan in false colours with its legend, dimensions and a scale bar.
std::string illuminance_figure(const ReportPlan& plan);

/// The plan's outlines with the numbers at measuring points; dots where there are too many to be read.
std::string values_figure(const ReportPlan& plan, std::span<const MeasuredGrid> areas);

}  // namespace interflect::command
