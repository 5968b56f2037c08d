// The page of a chart: its data as JSON, put into the page's parts.
#include "cli/chart/outputs.h"
#include "cli/chart/page_pictures.h"
#include "cli/page/page_parts.h"
#include "cli/pictures/beauty.h"
#include "cli/words/stats_json.h"
#include "film/files/atomic_file.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace keyhole {
namespace {

using Json = nlohmann::ordered_json;

/// The page stays below 5 MB: a pixel of a picture and of its errors takes about so many characters at worst.
constexpr double kMostCharacters = 4.5e6, kPerPixel = 4.0 * 4 / 3;

Json number(std::optional<double> x) { return x ? Json(*x) : Json(); }

Json point_json(const Point& p) {
    Json stages = Json::array();
    for (const auto& [name, seconds] : p.stages) stages.push_back({name, seconds});
    // NaN becomes null.
    return {{"seconds", p.seconds},
            {"memory", p.memory},
            {"cpu", p.cpu_seconds},
            {"error", p.error()},
            {"low", p.low()},
            {"high", p.high()},
            {"bias", p.squared.bias},
            {"variance", p.squared.variance},
            {"peakBytes", p.peak_bytes},
            {"photonBytes", p.photon_bytes},
            {"photons", p.photons},
            {"passes", p.passes},
            {"chosen", p.chosen},
            {"stages", stages}};
}

Json points_json(const std::vector<const Point*>& points) {
    Json list = Json::array();
    for (const Point* p : points) list.push_back(point_json(*p));
    return list;
}

Image mean_reference(const Reference& reference) {
    Image image = reference.first;
    if (reference.second)
        for (std::size_t i = 0; i < image.data.size(); ++i)
            image.data[i] = (image.data[i] + reference.second->data[i]) / 2;
    return image;
}

Json method_json(const SceneChart& chart, const std::string& method, const Image& reference, int shrink) {
    const auto points = chart.over_time(method);
    Json json{{"name", method},
              {"slope", number(slope(points))},
              {"time", points_json(points)},
              {"memory", points_json(chart.over_memory(method))}};
    if (!points.empty()) {
        const Image picture = shrunk(read_beauty(points.back()->picture), shrink);
        json["picture"] = picture_uri(picture, reference);
        json["errors"] = error_uri(picture, reference);
    }
    return json;
}

Json scene_json(const SceneChart& chart, const ChartOptions& options, int shrink) {
    const Image reference = shrunk(mean_reference(chart.reference), shrink);
    Json methods = Json::array();
    for (const std::string& method : options.methods) methods.push_back(method_json(chart, method, reference, shrink));
    return {{"name", chart.scene.name},
            {"width", chart.scene.width},
            {"height", chart.scene.height},
            {"shownWidth", reference.width},
            {"shownHeight", reference.height},
            {"shrink", shrink},
            {"reference",
             {{"method", chart.reference.method},
              {"standardError", chart.reference.standard_error},
              {"cpu", chart.reference.cpu_seconds},
              {"picture", picture_uri(reference, reference)}}},
            {"methods", methods},
            {"failures", chart.failures}};
}

/// How much smaller pictures are shown so that the page stays small.
int shrink_of(const std::vector<SceneChart>& charts, const ChartOptions& options) {
    double pixels = 0;
    for (const SceneChart& chart : charts)
        pixels += static_cast<double>(chart.scene.width) * chart.scene.height *
                  static_cast<double>(options.methods.size() + 1);
    return std::max(1, static_cast<int>(std::ceil(std::sqrt(pixels * kPerPixel / kMostCharacters))));
}

} // namespace

void write_page(const std::string& folder, const std::vector<SceneChart>& charts, const ChartOptions& options) {
    Json scenes = Json::array();
    const int shrink = shrink_of(charts, options);
    for (const SceneChart& chart : charts) scenes.push_back(scene_json(chart, options, shrink));
    const Json data{{"program", "keyhole " KEYHOLE_VERSION},
                    {"repeats", options.repeats},
                    {"methods", options.methods},
                    {"scenes", scenes}};
    write_file_atomically(folder + "/index.html", kChartPage.with(json_line(data)));
}

} // namespace keyhole
