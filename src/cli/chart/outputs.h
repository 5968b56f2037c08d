// What a chart leaves in its folder.
#pragma once

#include "cli/chart/analysis.h"

#include <string>
#include <vector>

namespace keyhole {

/// points.csv, runs.csv, stages.csv and methods.csv; docs/charts.md lists their columns.
/// @throws InputError if they can't be written, as all below.
void write_tables(const std::string& folder, const std::vector<SceneChart>& charts, const ChartOptions& options);

/// FOLDER/figures/SCENE-{time,memory,parts}.{svg,png}, drawn by gnuplot from files that stay beside them.
/// @returns a message if there is no gnuplot, or if it failed; else empty.
std::string draw_figures(const std::string& folder, const std::vector<SceneChart>& charts, const ChartOptions& options,
                         const StopToken& stop);

/// FOLDER/index.html, one file that needs no other.
void write_page(const std::string& folder, const std::vector<SceneChart>& charts, const ChartOptions& options);

} // namespace keyhole
