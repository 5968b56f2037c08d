#include "scene/load/pbrt/camera_film.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <type_traits>

namespace keyhole::pbrt {
namespace {

Imath::V3d row(const Transform& t, int i) { return {t[i][0], t[i][1], t[i][2]}; }

/// Stores a whole number in the setting of that name, as near as its range allows.
class SettingClamp {
  public:
    SettingClamp(std::string_view key, std::int64_t value) : key_(key), value_(value) {}

    template <class T, class... Rest> void operator()(std::string_view key, T& member, const Rest&... rest) {
        if constexpr (std::is_same_v<T, std::int64_t>) {
            const auto range = std::tie(rest...); // least, most, help
            if (key == key_) member = stored_ = std::clamp(value_, std::get<0>(range), std::get<1>(range));
        }
    }

    std::int64_t stored() const { return stored_; }

  private:
    std::string_view key_;
    std::int64_t value_, stored_ = 0;
};

void store(Parameters& p, Settings& settings, std::string_view key, std::int64_t value) {
    SettingClamp clamp(key, value);
    visit_settings(settings, clamp);
    if (clamp.stored() != value)
        p.warn(std::string(key), fmt::format("{} becomes {} = {}", value, key, clamp.stored()));
}

/// The window at distance 1 and a field of view of 90 degrees.
struct ScreenWindow {
    double half = 1; ///< of the extent across the film's shorter side
    Imath::V2d middle{0, 0};
};
ScreenWindow read_window(Parameters& p, const ImageWindow& film) {
    const double aspect = static_cast<double>(film.width) / film.height;
    if (const Parameter* ratio = p.find("frameaspectratio", {"float", "integer"});
        ratio != nullptr && std::abs(p.number("frameaspectratio", aspect) / aspect - 1) > 2e-3)
        p.fail(fmt::format("found a frame of aspect ratio {} on a film of {}, expected square pixels",
                           p.number("frameaspectratio", aspect), aspect));
    if (p.find("screenwindow", {"float"}) == nullptr) return {};
    const std::vector<double> w = p.numbers("screenwindow", {"float"});
    if (w.size() != 4) p.fail(fmt::format("found {} numbers in 'screenwindow', expected 4", w.size()));
    const double x = (w[1] - w[0]) / 2, y = (w[3] - w[2]) / 2;
    if (!(x > 0 && y > 0)) p.fail("found an empty 'screenwindow', expected two ranges of numbers that rise");
    if (std::abs(x / y / aspect - 1) > 2e-3)
        p.fail(fmt::format("found a 'screenwindow' of aspect ratio {} on a film of {}, expected square pixels", x / y,
                           aspect));
    return {std::min(x, y), {(w[0] + w[1]) / 2, (w[2] + w[3]) / 2}};
}

/// Shares of the film, or pixels; none where all of it is rendered.
std::optional<CropWindow> read_crop(Parameters& p, const ImageWindow& film) {
    const bool shares = p.has("cropwindow");
    if (!shares && !p.has("pixelbounds")) return std::nullopt;
    const char* name = shares ? "cropwindow" : "pixelbounds";
    const std::vector<double> c = shares ? p.numbers(name, {"float"}) : p.numbers(name, {"integer"});
    if (c.size() != 4) p.fail(fmt::format("found {} numbers in '{}', expected 4", c.size(), name));
    const auto pixel = [&](double x, int size) {
        return static_cast<int>(std::clamp(shares ? std::ceil(x * size) : x, -1.0, size + 1.0));
    };
    const CropWindow crop{pixel(c[0], film.width), pixel(c[2], film.height), pixel(c[1], film.width),
                          pixel(c[3], film.height)};
    if (!(crop.x0 >= 0 && crop.y0 >= 0 && crop.x0 < crop.x1 && crop.y0 < crop.y1 && crop.x1 <= film.width &&
          crop.y1 <= film.height))
        p.fail(fmt::format("found '{}' [ {} {} {} {} ], expected pixels of a film of {} x {}", name, c[0], c[1], c[2],
                           c[3], film.width, film.height));
    return crop;
}

} // namespace

void read_film(Parameters& p, View& view) {
    const std::string& kind = p.directive().words[0];
    if (kind != "rgb" && kind != "image") // the latter: v3
        p.warn("film", "an RGB picture is made");
    view.window.width = static_cast<int>(p.integer("xresolution", 1280, 1, 65536));
    view.window.height = static_cast<int>(p.integer("yresolution", 720, 1, 65536));
    if (static_cast<std::int64_t>(view.window.width) * view.window.height > (std::int64_t{1} << 28))
        p.fail(fmt::format("found {} x {} pixels, expected 2^28 at most", view.window.width, view.window.height));
    view.exposure = p.number("iso", 100, {1e-6, 1e9}) / 100;
    view.crop = read_crop(p, view.window);
    if (p.string("sensor", "cie1931") != "cie1931")
        p.warn("sensor", "the picture is taken as the eye sees it, not by a sensor");
    p.ignore({"filename", "diagonal", "savefp16", "maxcomponentvalue", "scale"});
    p.warn_of_the_rest();
}

void read_camera(Parameters& p, const Transform& camera_to_world, View& view) {
    const bool parallel = p.directive().words[0] == "orthographic";
    if (!parallel && p.directive().words[0] != "perspective")
        p.fail(fmt::format("found the camera '{}', expected perspective or orthographic", p.directive().words[0]));
    const double fov = p.has("halffov") ? 2 * p.number("halffov", 45, {5e-4, 89.5}) : p.number("fov", 90, {1e-3, 179});
    const ScreenWindow window = read_window(p, view.window);
    const double half = std::tan(fov * kPi / 360) * window.half;

    const Imath::V3d right = row(camera_to_world, 0), up = row(camera_to_world, 1), forward = row(camera_to_world, 2);
    const double scale = forward.length();
    const double tolerance = 1e-3 * scale * scale; // files give six digits
    if (std::abs(right.length2() - up.length2()) > tolerance || std::abs(up.length2() - scale * scale) > tolerance ||
        std::abs(right.dot(up)) > tolerance || std::abs(up.dot(forward)) > tolerance ||
        std::abs(forward.dot(right)) > tolerance)
        p.fail("found a transform that stretches the camera, expected moves, turns, mirrors and even scales");
    CameraParameters& camera = view.camera;
    const Imath::V3d origin = row(camera_to_world, 3);
    for (const double x : {origin.x, origin.y, origin.z})
        if (!(std::abs(x) <= 1e12))
            p.fail(fmt::format("found the camera at the coordinate {}, expected one within 1e12", x));
    camera.origin = Vec3(origin);
    const Imath::V3d f = forward.normalized(), r = (right - f * right.dot(f)).normalized();
    camera.forward = Vec3(f);
    camera.right = Vec3(r);
    const Imath::V3d u = f.cross(r);
    camera.up = Vec3(u.dot(up) < 0 ? -u : u);
    camera.fov_degrees = static_cast<float>(std::atan(half) * 360 / kPi);
    camera.shift = window.middle / (2 * window.half);
    camera.lens_radius = static_cast<float>(p.number("lensradius", 0, {0, 1e12}) * scale);
    camera.focus_distance = static_cast<float>(p.number("focaldistance", 1e6, kPositive) * scale);
    if (parallel) camera = orthographic(camera, 2 * window.half * scale);
    const double open = p.number("shutteropen", 0), close = p.number("shutterclose", 1);
    if (!(close > open)) p.fail(fmt::format("found the shutter open from {} to {}, expected some time", open, close));
    view.exposure *= close - open;
    if (view.crop) {
        camera = cropped(camera, view.window, *view.crop);
        view.window = {view.crop->x1 - view.crop->x0, view.crop->y1 - view.crop->y0, view.window.margin};
    }
    p.warn_of_the_rest();
}

void read_sampler(Parameters& p, Settings& settings) {
    constexpr std::int64_t kMost = 1 << 24;
    if (p.has("pixelsamples"))
        store(p, settings, "spp", p.integer("pixelsamples", 16, 0, kMost));
    else if (p.has("xsamples") || p.has("ysamples"))
        store(p, settings, "spp", p.integer("xsamples", 4, 0, 4096) * p.integer("ysamples", 4, 0, 4096));
    // Settings of samplers that we have no use for.
    p.ignore({"seed", "randomization", "jitter", "dimensions"});
    p.warn_of_the_rest();
}

void read_integrator(Parameters& p, Settings& settings) {
    static const std::set<std::string_view> kTransport{
        "path", "volpath", "bdpt", "mlt", "sppm", "simplepath", "simplevolpath", "lightpath", "directlighting"};
    if (!kTransport.contains(p.directive().words[0]))
        p.warn("integrator", "the picture shows light transport, whatever this integrator would show");
    store(p, settings, "max_depth", p.integer("maxdepth", 5, 0, 1 << 24));
    // How others sample is none of our business.
    p.ignore({"lightsampler",
              "lightsamplestrategy",
              "regularize",
              "rrthreshold",
              "radius",
              "numiterations",
              "iterations",
              "photonsperiteration",
              "imagewritefrequency",
              "seed",
              "bootstrapsamples",
              "chains",
              "mutationsperpixel",
              "largestepprobability",
              "sigma",
              "visualizestrategies",
              "visualizeweights",
              "samplebsdf",
              "samplelights",
              "strategy"});
    p.warn_of_the_rest();
}

void read_filter(Parameters& p, Settings& settings) {
    const std::string& kind = p.directive().words[0];
    const auto shape = choice_of<FilterShape>(kind);
    const auto radius = [&](std::string_view v4, std::string_view v3, double usual) {
        const double r = p.number(v4, p.number(v3, usual, kPositive), kPositive);
        if (r > 16) p.fail(fmt::format("found a radius of {} pixels, expected 16 at most", r));
        return r;
    };
    if (!shape) {
        p.warn("filter " + kind, "the picture is filtered by a Gaussian that reaches one pixel");
        return;
    }
    const double usual = *shape == FilterShape::box ? 0.5 : *shape == FilterShape::triangle ? 2 : 1.5;
    settings.filter = *shape;
    settings.filter_radius = radius("xradius", "xwidth", usual);
    if (radius("yradius", "ywidth", usual) != settings.filter_radius)
        p.warn("oblong filter", "the filter reaches as far vertically as horizontally");
    if (*shape != FilterShape::gaussian) return p.warn_of_the_rest();
    settings.filter_sigma = p.number("sigma", 0.5, {1e-3, 16});
    // v3 gives 1 / (2 sigma^2).
    if (p.has("alpha")) settings.filter_sigma = std::sqrt(0.5 / p.number("alpha", 2, {1e-3, 1e5}));
    p.warn_of_the_rest();
}

} // namespace keyhole::pbrt
