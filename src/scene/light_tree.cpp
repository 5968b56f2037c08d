#include "scene/light_tree.h"

#include <Imath/ImathBox.h>

#include <algorithm>

namespace keyhole {
namespace {

constexpr double kByPower = 0.125; // share of the choice that looks at power only
constexpr std::size_t kFewEmitters = 3;

double mixed(double by_power, double by_effect) { return kByPower * by_power + (1 - kByPower) * by_effect; }

double safe_acos(double x) { return std::acos(std::clamp(x, -1.0, 1.0)); }

/// The smallest cone around two cones of normals.
void merge_cones(EmitterBounds& a, const EmitterBounds& b) {
    const EmitterBounds &wide = a.spread >= b.spread ? a : b, &narrow = a.spread >= b.spread ? b : a;
    const double between = safe_acos(wide.axis.dot(narrow.axis));
    const double reach = std::max(a.reach, b.reach);
    if (std::min(between + narrow.spread, kPi) <= wide.spread) {
        a.axis = wide.axis;
        a.spread = wide.spread;
    } else {
        const double spread = std::min((wide.spread + between + narrow.spread) / 2, kPi), turn = spread - wide.spread;
        const Vec3 side = narrow.axis - wide.axis * wide.axis.dot(narrow.axis);
        const bool apart = side.length2() > 1e-8f;
        a.axis = apart ? wide.axis * static_cast<float>(std::cos(turn)) +
                             side.normalized() * static_cast<float>(std::sin(turn))
                       : wide.axis;
        // Axes that are alike but for rounding may stay as they are; opposite ones leave it open which way to turn.
        a.spread = apart ? spread : between < 1 ? std::min(wide.spread + between, kPi) : kPi;
    }
    a.reach = reach;
}

void merge(EmitterBounds& a, const EmitterBounds& b) {
    merge_cones(a, b);
    for (int k = 0; k < 3; ++k) {
        a.lower[k] = std::min(a.lower[k], b.lower[k]);
        a.upper[k] = std::max(a.upper[k], b.upper[k]);
    }
    a.intensity += b.intensity;
}

double sine(double cosine) { return std::sqrt(std::max(0.0, 1 - cosine * cosine)); }

/// An angle in [0, pi] by its cosine and sine: differences cost no inverse functions.
struct Angle {
    double cosine, sine;
};
Angle angle_of(double cosine) { return {cosine, sine(cosine)}; }
/// max(0, a - b)
Angle reduced(const Angle& a, const Angle& b) {
    if (a.cosine >= b.cosine) return {1, 0};
    return {a.cosine * b.cosine + a.sine * b.sine, a.sine * b.cosine - a.cosine * b.sine};
}

} // namespace

/// Bound on the irradiance that emitters within bounds bring to a point, as far as direction and distance go; never
/// closer than half the size of the bounds.
double LightTree::importance(const SurfacePoint& point, const Node& node) {
    const EmitterBounds& b = node.bounds;
    const Vec3 center = (b.lower + b.upper) / 2, to_light = center - point.p;
    const double radius2 = Imath::V3d(b.upper - b.lower).length2() / 4, distance2 = Imath::V3d(to_light).length2();
    const double near2 = std::max({distance2, radius2, 1e-30});
    if (distance2 <= radius2) return b.intensity / near2; // within: nothing is known of directions
    const Vec3 w = to_light / static_cast<float>(std::sqrt(distance2));
    const double wide2 = radius2 / distance2;
    const Angle half_width{std::sqrt(1 - wide2), std::sqrt(wide2)};
    const double cosine = std::clamp(-static_cast<double>(b.axis.dot(w)), -1.0, 1.0);
    const Angle off_axis = reduced(reduced(angle_of(cosine), {node.cos_spread, node.sin_spread}), half_width);
    if (off_axis.cosine < node.cos_reach) return 0;
    // Scattering may go through the surface, so that both of its sides count.
    const double slant =
        point.site == Site::surface ? reduced(angle_of(std::min(1.0, point.abs_cos(w))), half_width).cosine : 1.0;
    return b.intensity * std::max(0.0, off_axis.cosine) * std::max(0.0, slant) / near2;
}

LightTree::LightTree(const std::vector<std::unique_ptr<Emitter>>& emitters, const EmitterDistribution& by_power,
                     const BoundingSphere& scene)
    : by_power_(&by_power) {
    if (emitters.size() < kFewEmitters) return;
    std::vector<Node> leaves;
    for (std::uint32_t i = 0; i < emitters.size(); ++i) {
        if (const auto bounds = emitters[i]->bounds()) {
            Node& leaf = leaves.emplace_back();
            leaf.bounds = *bounds;
            leaf.emitter = i;
        } else {
            const double beam = kPi * static_cast<double>(scene.radius) * scene.radius;
            far_.push_back({i, emitters[i]->power() / beam});
            far_irradiance_ += far_.back().irradiance;
        }
    }
    nodes_.reserve(2 * leaves.size());
    leaf_of_.assign(emitters.size(), SurfacePoint::kNone);
    if (!leaves.empty()) build(leaves, 0, leaves.size(), 0);
    for (Node& node : nodes_) {
        node.cos_spread = std::cos(node.bounds.spread);
        node.sin_spread = std::sin(node.bounds.spread);
        node.cos_reach = std::cos(std::min(node.bounds.reach, kPi)) - 1e-9; // rounding loses no light
    }
}

/// Splits at the median of the widest extent. Few scenes have emitters enough for more care to show.
std::uint32_t LightTree::build(std::vector<Node>& leaves, std::size_t begin, std::size_t end, std::uint32_t parent) {
    const auto index = static_cast<std::uint32_t>(nodes_.size());
    if (end - begin == 1) {
        nodes_.push_back(leaves[begin]);
        nodes_[index].parent = parent;
        leaf_of_[leaves[begin].emitter] = index;
        return index;
    }
    const auto center = [&](const Node& n) { return (n.bounds.lower + n.bounds.upper) / 2; };
    Imath::Box3f centers;
    for (std::size_t i = begin; i < end; ++i) centers.extendBy(center(leaves[i]));
    const auto axis = static_cast<int>(centers.majorAxis());
    const std::size_t middle = (begin + end) / 2;
    const auto at = [&](std::size_t i) { return leaves.begin() + static_cast<std::ptrdiff_t>(i); };
    std::nth_element(at(begin), at(middle), at(end), [&](const Node& a, const Node& b) {
        const float ca = center(a)[axis], cb = center(b)[axis];
        return ca != cb ? ca < cb : a.emitter < b.emitter;
    });
    nodes_.emplace_back().parent = parent;
    const std::uint32_t left = build(leaves, begin, middle, index), right = build(leaves, middle, end, index);
    nodes_[index].left = left;
    nodes_[index].right = right;
    nodes_[index].bounds = nodes_[left].bounds;
    merge(nodes_[index].bounds, nodes_[right].bounds);
    return index;
}

double LightTree::left_share(const SurfacePoint& point, const Node& node) const {
    const double l = importance(point, nodes_[node.left]), r = importance(point, nodes_[node.right]);
    if (l + r > 0) return l / (l + r);
    const double a = nodes_[node.left].bounds.intensity, b = nodes_[node.right].bounds.intensity;
    return a + b > 0 ? a / (a + b) : 0.5;
}

LightTree::Choice LightTree::sample(const SurfacePoint& point, double u) const {
    if (leaf_of_.empty() || u < kByPower) {
        const std::uint32_t chosen = by_power_->sample(leaf_of_.empty() ? u : u / kByPower);
        return {chosen, probability(point, chosen)};
    }
    const Choice chosen = sample_by_effect(point, (u - kByPower) / (1 - kByPower));
    return {chosen.emitter, mixed(by_power_->probability(chosen.emitter), chosen.probability)};
}

double LightTree::probability(const SurfacePoint& point, std::uint32_t emitter) const {
    const double power = by_power_->probability(emitter);
    return leaf_of_.empty() ? power : mixed(power, effect_probability(point, emitter));
}

LightTree::Choice LightTree::sample_by_effect(const SurfacePoint& point, double u) const {
    const double near = nodes_.empty() ? 0.0 : importance(point, nodes_[0]), total = near + far_irradiance_;
    if (!(total > 0)) {
        const std::uint32_t chosen = by_power_->sample(u);
        return {chosen, by_power_->probability(chosen)};
    }
    u *= total;
    if (u >= near && !far_.empty()) {
        u -= near;
        const auto chosen = std::ranges::find_if(far_, [&](const Far& f) { return (u -= f.irradiance) < 0; });
        const Far& far = chosen != far_.end() ? *chosen : far_.back();
        return {far.emitter, far.irradiance / total};
    }
    u /= near;
    double p = near / total;
    std::uint32_t i = 0;
    while (nodes_[i].left != 0) {
        const double share = left_share(point, nodes_[i]);
        const bool left = u < share;
        u = left ? u / share : (u - share) / (1 - share);
        p *= left ? share : 1 - share;
        i = left ? nodes_[i].left : nodes_[i].right;
    }
    return {nodes_[i].emitter, p};
}

double LightTree::effect_probability(const SurfacePoint& point, std::uint32_t emitter) const {
    const double near = nodes_.empty() ? 0.0 : importance(point, nodes_[0]), total = near + far_irradiance_;
    if (!(total > 0)) return by_power_->probability(emitter);
    const std::uint32_t i = leaf_of_[emitter];
    if (i == SurfacePoint::kNone) {
        const auto f = std::ranges::find(far_, emitter, &Far::emitter);
        return f->irradiance / total;
    }
    // From the root on, as sample_by_effect() multiplies: the same to the last bit.
    const auto reached = [&](const auto& self, std::uint32_t node) -> double {
        if (node == 0) return near / total;
        const std::uint32_t parent = nodes_[node].parent;
        const double left = left_share(point, nodes_[parent]);
        return self(self, parent) * (nodes_[parent].left == node ? left : 1 - left);
    };
    return reached(reached, i);
}

} // namespace keyhole
