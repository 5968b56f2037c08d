#include "core/integer_power.h"
#include "sampling/paths/path_tracer.h"
#include "sampling/primary/path_builder.h"

namespace keyhole {
namespace {

class PathTracingBuilder final : public PathBuilder {
  public:
    explicit PathTracingBuilder(const BuilderContext& c) : c_(c) {}

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

/// Whether a sub-path has n vertices, and ends where it can be joined to one from the other side. Asked before that is
/// traced: many candidates fail here.
bool is_whole(const TracedSubPath& walk, int n) {
    return walk.size() == n && (n <= 1 || walk.vertices.back().bsdf.traits().finite);
}

/// Traces s vertices from the light and t from the eye. False, and at least one of the two not to be used, if they make
/// no path. The shorter one comes first: where it fails, less was in vain.
bool trace_subpaths(const Scene& scene, const Vec2& image, int s, int t, PrimarySources sources, SubPathPair& room) {
    TracedSubPath &eye = room.eye, &light = room.light;
    const auto trace_light = [&] {
        trace_light_subpath(scene, s, sources.light, nullptr, light);
        return is_whole(light, s);
    };
    if (1 < s && s < t && !trace_light()) return false;
    trace_eye_subpath(scene, image, t, sources.eye, nullptr, eye);
    if (s == 0) return eye.size() == t && eye.vertices.back().point.is_emitter();
    return is_whole(eye, t) && ((1 < s && s < t) || trace_light());
}

/// Adds what one connection carries, divided by the probability of having chosen it.
void add_connection(Connection& connection, MisHeuristic heuristic, double probability, PathSample& sample) {
    if (!connection.possible()) return;
    const Rgb value = connection.value(heuristic);
    if (luminance(value) > 0 && connection.visible())
        sample.add(connection.image(), connection.light_class(), value / probability);
}

/// Numbers of vertices have geometric distributions.
class EndpointBuilder final : public PathBuilder {
  public:
    explicit EndpointBuilder(const BuilderContext& c) : c_(c) {}

    void build(PrimarySources sources, PathSample& sample) const override {
        const int t = 1 + geometric(sources.choice.next()), s = geometric(sources.choice.next());
        if (s + t < 2 || s + t - 2 > c_.max_scatterings) return;
        const Vec2 image = window_point(sources.eye);
        SubPathPair& room = SubPathPair::scratch();
        if (!trace_subpaths(*c_.scene, image, s, t, sources, room)) return;
        Connection connection(*c_.scene, room.light, s, room.eye, t, image);
        add_connection(connection, c_.heuristic, probability(t - 1) * probability(s), sample);
    }

  private:
    static constexpr double kContinue = 0.7;
    static int geometric(double u) { return static_cast<int>(std::log1p(-u) / std::log(kContinue)); }
    static double probability(int n) { return integer_power(kContinue, n) * (1 - kContinue); }

    BuilderContext c_;
};

class BidirectionalBuilder final : public PathBuilder {
  public:
    explicit BidirectionalBuilder(const BuilderContext& c) : c_(c) {}

    void build(PrimarySources sources, PathSample& sample) const override {
        const Vec2 image = window_point(sources.eye);
        SubPathPair& pair = trace_both_subpaths(*c_.scene, image, c_.max_scatterings, sources.eye, sources.light);
        struct {
            PathSample& sample;
            void contribution(const Connection& connection, const Rgb& value, LightClass kind) {
                sample.add(connection.image(), kind, value);
            }
        } sink{sample};
        connect_subpaths(*c_.scene, pair, image, {c_.max_scatterings, PathSet::all, c_.heuristic}, sink);
    }

  private:
    BuilderContext c_;
};

class MultiplexedBuilder final : public PathBuilder {
  public:
    MultiplexedBuilder(const BuilderContext& c, int scatterings) : c_(c), scatterings_(scatterings) {}

    void build(PrimarySources sources, PathSample& sample) const override {
        auto connection = multiplexed_connection(*c_.scene, scatterings_, sources, SubPathPair::scratch(sample.room()));
        if (connection) add_connection(*connection, c_.heuristic, 1.0 / technique_count(scatterings_), sample);
    }

  private:
    BuilderContext c_;
    int scatterings_;
};

} // namespace

std::optional<Connection> multiplexed_connection(const Scene& scene, int scatterings, PrimarySources sources,
                                                 SubPathPair& room) {
    const int s = chosen_technique(sources.choice.next(), scatterings);
    const int t = technique_count(scatterings) - s; // never 0: nothing meets the lens by chance
    const Vec2 image = window_point(sources.eye);
    if (!trace_subpaths(scene, image, s, t, sources, room)) return std::nullopt;
    return Connection(scene, room.light, s, room.eye, t, image);
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
