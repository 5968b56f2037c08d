#include "scene/pbrt/lights.h"

#include "scene/emitters/distant.h"
#include "scene/emitters/environment.h"
#include "scene/emitters/image_environment.h"
#include "scene/emitters/point.h"
#include "scene/emitters/spot.h"
#include "scene/load/suggest.h"

#include <fmt/format.h>

#include <cmath>
#include <map>

namespace keyhole::pbrt {
namespace {

/// What the readers of the kinds see.
struct Source {
    Parameters& p;
    const Transform& to_world;
    double exposure;

    /// The colour of a light times its scale. v3's scale may be a spectrum.
    Rgb color(std::string_view name) const {
        const Rgb light = p.spectrum(name, Rgb(1.0), SpectrumUse::light);
        const Parameter* scale = p.find("scale", {"float", "integer", "rgb", "spectrum"});
        if (scale != nullptr && (scale->type == "rgb" || scale->type == "spectrum"))
            return light * p.spectrum("scale", Rgb(1.0), SpectrumUse::light) * exposure;
        return light * (p.number("scale", 1, {0, 1e30}) * exposure);
    }

    Imath::V3d position(const Imath::V3d& own) const { return own * to_world; }
    Imath::V3d direction(const Imath::V3d& own) const {
        Imath::V3d v;
        to_world.multDirMatrix(own, v);
        if (!(v.length() > 0)) p.fail("found 'from' and 'to' at one place, expected two");
        return v.normalized();
    }
    /// Without its scale, as directions have none.
    Imath::M33d rotation() const {
        Imath::M33d m;
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) m[i][j] = to_world[i][j];
        return m * (1 / std::cbrt(std::abs(m.determinant())));
    }
    /// Power and illuminance that are not positive count as not given, as in pbrt.
    double target(std::string_view name) const { return p.number(name, -1, {-1e30, 1e30}); }
};

LightSource point(const Source& s) {
    Rgb intensity = s.color("I");
    if (const double power = s.target("power"); power > 0) intensity *= power / (4 * kPi);
    const Vec3 position(s.position(s.p.point("from", Imath::V3d(0.0))));
    if (is_black(intensity)) return {};
    return {make_point_emitter(position, intensity), false};
}

LightSource spot(const Source& s) {
    SpotParameters spot;
    spot.intensity = s.color("I");
    spot.edge_degrees = s.p.number("coneangle", 30, {1e-3, 180});
    spot.full_degrees = spot.edge_degrees - s.p.number("conedeltaangle", 5, {0, spot.edge_degrees});
    const Imath::V3d from = s.p.point("from", Imath::V3d(0.0)), to = s.p.point("to", Imath::V3d(0, 0, 1));
    spot.position = Vec3(s.position(from));
    spot.axis = Vec3(s.direction(to - from));
    if (const double power = s.target("power"); power > 0) spot.intensity *= power / spot_solid_angle(spot);
    if (is_black(spot.intensity)) return {};
    return {make_spot_emitter(spot), false};
}

LightSource distant(const Source& s) {
    Rgb irradiance = s.color("L");
    if (const double target = s.target("illuminance"); target > 0) irradiance *= target;
    const Imath::V3d from = s.p.point("from", Imath::V3d(0.0)), to = s.p.point("to", Imath::V3d(0, 0, 1));
    const Vec3 w(s.direction(to - from));
    if (is_black(irradiance)) return {};
    return {make_distant_emitter(w, irradiance), false};
}

LightSource infinite(const Source& s) {
    if (s.p.has("mapname"))
        s.p.fail(
            "found 'mapname', a picture by longitude and latitude as of pbrt-v3, expected 'filename' and a picture "
            "in pbrt-v4's equal-area octahedral map (imgtool makeequiarea makes one)");
    if (s.p.has("portal")) s.p.warn("portal", "the portal is ignored: the light comes from everywhere");
    const std::string file = s.p.string("filename", "");
    const double illuminance = s.target("illuminance");
    if (!file.empty() && s.p.has("L")) s.p.fail("found both 'L' and 'filename', expected one of them");
    if (!file.empty() && illuminance > 0) s.p.fail("found 'illuminance' of a picture, expected 'scale'");
    Rgb radiance = s.color("L");
    if (illuminance > 0) radiance *= illuminance / kPi;
    if (is_black(radiance)) return {};
    if (file.empty()) return {make_constant_environment(radiance), true};
    auto image = read_environment_image(s.p.context().resolve(file), SphereLayout::octahedral);
    return {make_image_environment(std::move(image), radiance, s.rotation()), true};
}

using Reader = LightSource (*)(const Source&);
const std::map<std::string_view, Reader>& readers() {
    static const std::map<std::string_view, Reader> table{
        {"point", point}, {"spot", spot}, {"distant", distant}, {"infinite", infinite}};
    return table;
}

} // namespace

AreaLight read_area_light(Parameters& p, double exposure) {
    const std::string& kind = p.directive().words[0];
    if (kind != "diffuse" && kind != "area") // the latter: v3
        p.fail(fmt::format("found the area light '{}', expected diffuse", kind));
    if (p.has("filename")) p.fail("found 'filename', expected emission that is the same everywhere");
    AreaLight light;
    light.radiance = Source{p, {}, exposure}.color("L");
    light.two_sided = p.boolean("twosided", false);
    light.power = std::max(0.0, p.number("power", -1, {-1e30, 1e30}));
    p.ignore({"samples", "nsamples"});
    p.warn_of_the_rest();
    return light;
}

LightSource read_light(Parameters& p, const Transform& to_world, double exposure) {
    const std::string& kind = p.directive().words[0];
    const auto reader = readers().find(kind);
    if (reader == readers().end()) {
        std::vector<std::string_view> names;
        for (const auto& [name, function] : readers()) names.push_back(name);
        p.fail(fmt::format("found the light '{}', {}", kind, expected_one_of(kind, names)));
    }
    LightSource light;
    try {
        light = reader->second({p, to_world, exposure});
    } catch (const InputError& e) {
        if (std::string_view(e.what()).find(p.directive().position.file) == std::string_view::npos) p.fail(e.what());
        throw;
    }
    p.ignore({"samples", "nsamples"});
    p.warn_of_the_rest();
    return light;
}

} // namespace keyhole::pbrt
