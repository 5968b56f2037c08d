#include "scene/load/gltf/nodes.h"

#include "scene/emitters/emitters.h"
#include "scene/load/gltf/primitives.h"
#include "scene/load/load_mesh.h"

#include <Imath/ImathQuat.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace keyhole::gltf {
namespace {

constexpr std::size_t kMostDepth = 256;
constexpr const char* kLights = "KHR_lights_punctual";
constexpr int kPlainWidth = 640, kPlainHeight = 480;

/// From the node to its parent.
Transform transform_of(const Json& node) {
    Transform t;
    if (node.contains("matrix")) { // by columns, for column vectors: Imath's rows
        const auto m = value_or(node, "matrix", std::array<double, 16>{});
        std::copy(m.begin(), m.end(), &t[0][0]);
        return t;
    }
    const auto scale = value_or(node, "scale", std::array{1.0, 1.0, 1.0}),
               place = value_or(node, "translation", std::array{0.0, 0.0, 0.0});
    const auto turn = value_or(node, "rotation", std::array{0.0, 0.0, 0.0, 1.0});
    t.setScale(Imath::V3d(scale[0], scale[1], scale[2]));
    t *= Imath::Quatd(turn[3], turn[0], turn[1], turn[2]).normalized().toMatrix44();
    return t * Transform().translate(Imath::V3d(place[0], place[1], place[2]));
}

Vec3 turned(const Transform& t, const Imath::V3d& direction) {
    Imath::V3d result;
    t.multDirMatrix(direction, result);
    return Vec3(result.normalized());
}

class Walker {
  public:
    explicit Walker(const Document& document) : document_(document), left_out_(document) {}

    LightsAndCamera walk() {
        const Json& root = document_.root();
        if (root.contains("scenes")) {
            const Json& scene = document_.entry("scenes", value_or<std::size_t>(root, "scene", 0));
            visit_all(value_or(scene, "nodes", std::vector<std::size_t>{}), Transform());
        }
        tell_of_flattened();
        return std::move(things_);
    }

  private:
    /// Exporters hide objects by a scale of 0, as the specification has it.
    void tell_of_flattened() const {
        if (flattened_.empty()) return;
        const std::size_t more = flattened_.size() - 1;
        document_.warn(fmt::format("{}{} left out: a scale of 0 flattens what is there", flattened_.front(),
                                   more == 0 ? " is" : fmt::format(" and {} more are", more)));
    }

    void visit_all(const std::vector<std::size_t>& nodes, const Transform& parent) {
        if (above_.size() > kMostDepth) document_.fail(fmt::format("found nodes nested more than {} deep", kMostDepth));
        for (const std::size_t index : nodes) {
            if (std::ranges::find(above_, index) != above_.end())
                document_.fail(fmt::format("found node {} below itself, expected no recursive nodes", index));
            const Json& node = document_.entry("nodes", index);
            const Transform to_world =
                document_.within(called("node", index, node), [&] { return read_node(index, parent); });
            above_.push_back(index);
            visit_all(value_or(node, "children", std::vector<std::size_t>{}), to_world);
            above_.pop_back();
        }
    }

    /// What hangs on a node. Returns where that is.
    Transform read_node(std::size_t index, const Transform& parent) {
        const Json& node = document_.entry("nodes", index);
        const Transform to_world = transform_of(node) * parent;
        const bool holds = node.contains("mesh") || node.contains("camera") || extension(node, kLights) != nullptr;
        if (!holds || is_regular(to_world))
            read_things(node, to_world);
        else
            flattened_.push_back(called("node", index, node));
        return to_world;
    }

    void read_things(const Json& node, const Transform& to_world) {
        if (node.contains("mesh")) left_out_.note(value_of<std::size_t>(node["mesh"], "mesh"));
        if (node.contains("camera") && !things_.view)
            read_camera(value_of<std::size_t>(node["camera"], "camera"), to_world);
        if (const Json* light = extension(node, kLights))
            read_light(value_of<std::size_t>(light->at("light"), "light"), to_world);
        if (node.contains("skin")) document_.warn("skins are left out: meshes stand as they are bound");
    }

    void read_camera(std::size_t index, const Transform& to_world) {
        const Json& camera = document_.entry("cameras", index);
        if (!camera.contains("perspective")) return document_.warn("cameras without perspective are left out");
        const Json& lens = camera["perspective"];
        const double aspect =
            std::clamp(value_or(lens, "aspectRatio", double(kPlainWidth) / kPlainHeight), 0.01, 100.0);
        const double upright = std::tan(lens.at("yfov").get<double>() / 2);
        View view;
        view.window.width = aspect >= 1 ? kPlainWidth : static_cast<int>(std::lround(kPlainWidth * aspect));
        view.window.height = aspect >= 1 ? static_cast<int>(std::lround(kPlainWidth / aspect)) : kPlainWidth;
        const double degrees = 2 * std::atan(upright * std::min(aspect, 1.0)) * 180 / kPi;
        if (!(degrees >= 0.001 && degrees <= 179))
            document_.fail("found a camera whose field of view isn't within 0.001 and 179 degrees");
        view.camera.fov_degrees = static_cast<float>(degrees);
        view.camera.origin = Vec3(to_world.translation());
        view.camera.forward = turned(to_world, {0, 0, -1});
        view.camera.right = view.camera.forward.cross(turned(to_world, {0, 1, 0})).normalized();
        view.camera.up = view.camera.right.cross(view.camera.forward);
        things_.view = view;
    }

    void read_light(std::size_t index, const Transform& to_world) {
        const Json* all = extension(document_.root(), kLights);
        if (all == nullptr || !all->contains("lights") || index >= (*all)["lights"].size())
            document_.fail(fmt::format("found no light {}, which is referred to", index));
        const Json& light = (*all)["lights"][index];
        document_.within(called("light", index, light), [&] { place_light(light, to_world); });
    }

    void place_light(const Json& light, const Transform& to_world) {
        const auto type = light.at("type").get<std::string>();
        // What is wrong is said in the units of the file.
        const Rgb amount =
            document_.checked_light(color_or(light, "color", Rgb(1.0)) * value_or(light, "intensity", 1.0)) *
            (1 / kLumensPerWatt);
        const Vec3 place(to_world.translation()), forward = turned(to_world, {0, 0, -1});
        if (is_black(amount)) return;
        if (type == "directional")
            things_.emitters.push_back(make_distant_emitter(forward, amount));
        else if (type == "point")
            things_.emitters.push_back(make_point_emitter(place, amount));
        else if (type == "spot")
            things_.emitters.push_back(make_spot_emitter(spot(member(light, "spot"), place, forward, amount)));
        else
            document_.fail(fmt::format("found a light of type '{}', expected point, spot or directional", type));
    }

    SpotParameters spot(const Json& cone, const Vec3& place, const Vec3& forward, const Rgb& intensity) const {
        constexpr double kMost = kPi / 2 + 1e-6; // which floats may round up
        const double outer = value_or(cone, "outerConeAngle", kPi / 4), inner = value_or(cone, "innerConeAngle", 0.0);
        if (!(inner >= 0 && inner <= outer && outer > 0 && outer <= kMost))
            document_.fail(
                fmt::format("found 'innerConeAngle' {} and 'outerConeAngle' {}, expected 0 <= inner <= outer "
                            "<= pi/2, and some width",
                            inner, outer));
        return {place, forward, intensity, inner * 180 / kPi, outer * 180 / kPi, SpotFade::squared};
    }

    const Document& document_;
    LightsAndCamera things_;
    LeftOutParts left_out_;
    std::vector<std::string> flattened_; ///< nodes with something on them
    std::vector<std::size_t> above_;     ///< nodes that hold the one that is read
};

} // namespace

LightsAndCamera read_nodes(const Document& document) { return Walker(document).walk(); }

} // namespace keyhole::gltf
