#include "sampling/path_tracer.h"
#include "sampling/primary/path_builder.h"

namespace keyhole {
namespace {

class PathTracingBuilder final : public PathBuilder {
  public:
    explicit PathTracingBuilder(const BuilderContext& c) : c_(c) {}
    std::string_view name() const override { return "path"; }

    void build(PrimarySources sources, PathSample& sample) const override {
        struct {
            const Vec2 image;
            PathSample& sample;
            static bool arrival(const EyeWalk&, const Rgb&, int) { return true; }
            void contribution(const EyeWalk&, const Vertex&, const Rgb& value, LightClass light) {
                sample.add(image, light, value);
            }
        } sink{window_point(sources.eye), sample};
        trace_path(*c_.scene, sink.image, c_.max_scatterings, sources.eye, sink);
    }

  private:
    BuilderContext c_;
};

/// Whether the end of a whole eye sub-path can be joined to s vertices from the light at all. Asked before those are
/// traced: many candidates fail here.
bool can_be_joined(const TracedSubPath& eye, int s) {
    const Vertex& end = eye.vertices.back();
    return s == 0 ? end.point.is_emitter() : eye.size() == 1 || end.bsdf.traits().finite;
}

/// Adds what one joint carries, divided by the probability of having chosen it.
void add_joint(Joint& joint, MisHeuristic heuristic, double probability, PathSample& sample) {
    if (!joint.possible()) return;
    const Rgb value = joint.value(heuristic);
    if (luminance(value) > 0 && joint.visible()) sample.add(joint.image(), joint.light_class(), value / probability);
}

/// Numbers of vertices have geometric distributions.
class EndpointBuilder final : public PathBuilder {
  public:
    explicit EndpointBuilder(const BuilderContext& c) : c_(c) {}
    std::string_view name() const override { return "endpoints"; }

    void build(PrimarySources sources, PathSample& sample) const override {
        const int t = 1 + geometric(sources.choice.next()), s = geometric(sources.choice.next());
        if (s + t < 2 || s + t - 2 > c_.max_scatterings) return;
        const Vec2 image = window_point(sources.eye);
        auto& [eye, light] = SubPathPair::scratch();
        trace_eye_subpath(*c_.scene, image, t, sources.eye, nullptr, eye);
        if (eye.size() < t || !can_be_joined(eye, s)) return;
        trace_light_subpath(*c_.scene, s, sources.light, nullptr, light);
        if (light.size() < s) return;
        Joint joint(*c_.scene, light, s, eye, t, image);
        add_joint(joint, c_.heuristic, probability(t - 1) * probability(s), sample);
    }

  private:
    static constexpr double kContinue = 0.7;
    static int geometric(double u) { return static_cast<int>(std::log1p(-u) / std::log(kContinue)); }
    static double probability(int n) { return std::pow(kContinue, n) * (1 - kContinue); }

    BuilderContext c_;
};

class BidirectionalBuilder final : public PathBuilder {
  public:
    explicit BidirectionalBuilder(const BuilderContext& c) : c_(c) {}
    std::string_view name() const override { return "bidirectional"; }

    void build(PrimarySources sources, PathSample& sample) const override {
        const Vec2 image = window_point(sources.eye);
        auto& [eye, light] = SubPathPair::scratch();
        trace_eye_subpath(*c_.scene, image, most_eye_vertices(c_.max_scatterings), sources.eye, &sources.eye, eye);
        trace_light_subpath(*c_.scene, most_light_vertices(c_.max_scatterings), sources.light, &sources.light, light);
        struct {
            PathSample& sample;
            void contribution(const Joint& joint, const Rgb& value, LightClass kind) {
                sample.add(joint.image(), kind, value);
            }
        } sink{sample};
        connect_subpaths(*c_.scene, light, eye, image, c_.max_scatterings, PathSet::all, c_.heuristic, sink);
    }

  private:
    BuilderContext c_;
};

class MultiplexedBuilder final : public PathBuilder {
  public:
    MultiplexedBuilder(const BuilderContext& c, int scatterings) : c_(c), scatterings_(scatterings) {}
    std::string_view name() const override { return "multiplexed"; }

    void build(PrimarySources sources, PathSample& sample) const override {
        auto joint = multiplexed_joint(*c_.scene, scatterings_, sources);
        if (joint) add_joint(*joint, c_.heuristic, 1.0 / technique_count(scatterings_), sample);
    }

  private:
    BuilderContext c_;
    int scatterings_;
};

} // namespace

std::optional<Joint> multiplexed_joint(const Scene& scene, int scatterings, PrimarySources sources) {
    const int s = chosen_technique(sources.choice.next(), scatterings);
    const int t = technique_count(scatterings) - s; // never 0: nothing meets the lens by chance
    const Vec2 image = window_point(sources.eye);
    auto& [eye, light] = SubPathPair::scratch();
    trace_eye_subpath(scene, image, t, sources.eye, nullptr, eye);
    if (eye.size() < t || !can_be_joined(eye, s)) return std::nullopt;
    trace_light_subpath(scene, s, sources.light, nullptr, light);
    if (light.size() < s) return std::nullopt;
    return Joint(scene, light, s, eye, t, image);
}

std::unique_ptr<PathBuilder> make_path_builder(const BuilderContext& context) {
    return std::make_unique<PathTracingBuilder>(context);
}
std::unique_ptr<PathBuilder> make_endpoint_builder(const BuilderContext& context) {
    return std::make_unique<EndpointBuilder>(context);
}
std::unique_ptr<PathBuilder> make_bidirectional_builder(const BuilderContext& context) {
    return std::make_unique<BidirectionalBuilder>(context);
}
std::unique_ptr<PathBuilder> make_multiplexed_builder(const BuilderContext& context, int scatterings) {
    return std::make_unique<MultiplexedBuilder>(context, scatterings);
}

} // namespace keyhole
