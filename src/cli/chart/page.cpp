// The page of a chart: its data as JSON, put into the page's parts.
#include "cli/chart/outputs.h"
#include "cli/page/page_parts.h"
#include "cli/pictures/beauty.h"
#include "cli/words/report.h"
#include "film/files/atomic_file.h"
#include "film/image_error.h"
#include "film/tonemap.h"

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

/// Means over squares of `factor` pixels; rests at the right and at the bottom are left out.
Image shrunk(const Image& image, int factor) {
    if (factor == 1) return image;
    Image small(image.width / factor, image.height / factor, image.channels);
    const float share = 1 / static_cast<float>(factor * factor);
    for (int y = 0; y < small.height * factor; ++y)
        for (int x = 0; x < small.width * factor; ++x)
            for (int k = 0; k < image.channels; ++k) small.at(x / factor, y / factor)[k] += share * image.at(x, y)[k];
    return small;
}

/// The picture tone-mapped as the reference is, as a PNG in a data URI.
std::string picture_uri(const Image& image, const Image& reference) {
    return png_uri(image.width, image.height, 3, tonemap(image, reference));
}

/// The relative error of each pixel's luminance, signed, over |R| + 0.1 mean(R): a grey PNG in a data URI, whose byte
/// is 128 + 127 s sqrt(min(|e|, 1)), s being the sign.
std::string error_uri(const Image& image, const Image& reference) {
    const Grey i(image), r(reference);
    const double floor = 0.1 * mean(r.y);
    std::vector<std::uint8_t> bytes(i.y.size(), 128);
    for (std::size_t p = 0; p < bytes.size(); ++p) {
        const double e = (i.y[p] - r.y[p]) / (std::abs(r.y[p]) + floor);
        if (std::isfinite(e))
            bytes[p] = static_cast<std::uint8_t>(
                std::lround(128 + 127 * std::copysign(std::sqrt(std::min(std::abs(e), 1.0)), e)));
    }
    return png_uri(image.width, image.height, 1, bytes);
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
    const Reference& given = chart.reference;
    const Image reference = shrunk(given.second ? mean_of(given.first, *given.second) : given.first, shrink);
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
