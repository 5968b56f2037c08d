#include "sampling/primary/reversible_jump.h"

#include "sampling/markov/acceptance.h"
#include "scene/bsdfs/fresnel.h"
#include "scene/geometry.h"

#include <cmath>

namespace keyhole {
namespace {

constexpr double kBelowOne = 1 - 0x1p-53;

double turn(double y, double x) { // as a share of a full turn, in [0,1)
    const double t = std::atan2(y, x) / (2 * kPi);
    return std::min(t < 0 ? t + 1 : t, kBelowOne);
}

double between(double low, double high, SampleSource& rng) {
    return std::min(low + (high - low) * rng.next(), kBelowOne);
}

/// Inverse of cosine_hemisphere().
std::array<double, 2> invert_hemisphere(const Vec3& w) {
    const double z = w.z;
    return {std::clamp(1 - z * z, 0.0, kBelowOne), turn(w.y, w.x)};
}

/// Inverse of Ggx::sample_visible().
std::array<double, 2> invert_visible(const Ggx& ggx, const LocalVec& w, const LocalVec& h) {
    const LocalVec v = LocalVec(ggx.alpha_x * w.x, ggx.alpha_y * w.y, w.z).normalized();
    const LocalVec n = LocalVec(h.x / ggx.alpha_x, h.y / ggx.alpha_y, h.z).normalized();
    const double length = std::hypot(v.x, v.y);
    const LocalVec t1 = length > 0 ? LocalVec(-v.y / length, v.x / length, 0) : LocalVec(1, 0, 0);
    const LocalVec t2 = v.cross(t1);
    const double p1 = n.dot(t1), s = (1 + v.z) / 2;
    const double p2 = (n.dot(t2) - (1 - s) * std::sqrt(std::max(0.0, 1 - p1 * p1))) / s;
    return {std::clamp(p1 * p1 + p2 * p2, 0.0, kBelowOne), turn(p2, p1)};
}

using Numbers = std::optional<std::array<double, 3>>;

/// One overload for each model that has an inverse. Directions are local.
struct Inverter {
    Vec3 back, to;
    Event event;
    SampleSource& rng;

    Numbers anything() const { return {{rng.next(), rng.next(), rng.next()}}; }

    Numbers operator()(const DiffuseBsdf&) const {
        const auto [u0, u1] = invert_hemisphere({to.x, to.y, std::abs(to.z)});
        return {{u0, u1, rng.next()}};
    }
    Numbers operator()(const MirrorBsdf&) const { return anything(); }
    Numbers operator()(const ConductorBsdf&) const { return anything(); }
    Numbers operator()(const RoughConductorBsdf& m) const {
        const LocalVec w = upper(back);
        const auto [u0, u1] = invert_visible({m.alpha_x, m.alpha_y}, w, half_vector(w, upper(to)));
        return {{u0, u1, rng.next()}};
    }
    Numbers operator()(const GlassBsdf& m) const {
        const double r = fresnel_dielectric(std::abs(back.z), back.z > 0 ? m.eta : 1 / m.eta).reflectance;
        const double u2 = event == Event::reflect ? between(0, r, rng) : between(r, 1, rng);
        return {{rng.next(), rng.next(), u2}};
    }
    template <class Model> Numbers operator()(const Model&) const { return std::nullopt; }
};

/// Ratio of the MIS weights of two techniques of the same path, whose densities have the ratio `densities`.
double weight_ratio(double densities, MisHeuristic heuristic) {
    switch (heuristic) {
    case MisHeuristic::balance:
        return densities;
    case MisHeuristic::power:
        return densities * densities;
    case MisHeuristic::maximum:
        break;
    }
    return 0; // one technique has it all
}

/// Where a stream keeps the numbers of vertex j's continuation: what the tracers of sub-paths ask for before it. Those
/// of light are for emitters on surfaces.
constexpr std::size_t kEyeBsdf = 4; // after the window point and the point on the lens
constexpr std::size_t kEmitterRay = 4, kLightBsdf = 6;
std::size_t eye_bsdf(int j) { return kEyeBsdf + 3 * static_cast<std::size_t>(j - 1); }
std::size_t light_bsdf(int j) { return kLightBsdf + 3 * static_cast<std::size_t>(j - 1); }

} // namespace

std::optional<std::array<double, 3>> invert_bsdf(const Vertex& v, const Vec3& back, const Vec3& to, SampleSource& rng) {
    const Frame frame = v.point.shading_frame();
    if (frame.n != v.bsdf.shading_normal()) return std::nullopt; // bumped: the frame is not the point's
    return std::visit(Inverter{frame.to_local(back), frame.to_local(to), v.event, rng}, v.bsdf.model());
}

EmitterInverse::EmitterInverse(const Scene& scene) : scene_(&scene), triangles_(scene.shapes().size()) {
    choice_.push_back(0);
    for (std::uint32_t i = 0; i < scene.emitters().size(); ++i)
        choice_.push_back(choice_.back() + scene.emitter_distribution().probability(i));
    for (std::size_t i = 0; i < scene.shapes().size(); ++i) {
        const Shape& shape = scene.shapes()[i];
        const auto* mesh = std::get_if<TriangleMesh>(&shape.geometry);
        if (mesh == nullptr || !shape.emission || shape.emission->two_sided) continue;
        std::vector<double> areas(mesh->triangles.size());
        for (std::uint32_t k = 0; k < areas.size(); ++k) areas[k] = triangle_area(*mesh, k);
        triangles_[i] = EmitterDistribution(areas);
    }
}

std::optional<std::array<double, 4>> EmitterInverse::point(const SurfacePoint& point, SampleSource& rng) const {
    if (point.shape == SurfacePoint::kNone || triangles_[point.shape].empty()) return std::nullopt;
    const EmitterDistribution& triangles = triangles_[point.shape];
    double before = 0;
    for (std::uint32_t k = 0; k < point.primitive; ++k) before += triangles.probability(k);
    const auto& mesh = std::get<TriangleMesh>(scene_->shapes()[point.shape].geometry);
    const auto& corners = mesh.triangles[point.primitive];
    const Imath::V3d a(mesh.positions[corners[0]]), e1 = Imath::V3d(mesh.positions[corners[1]]) - a,
                                                    e2 = Imath::V3d(mesh.positions[corners[2]]) - a,
                                                    p = Imath::V3d(point.p) - a;
    // Barycentric coordinates of the second and third corner.
    const double d11 = e1.dot(e1), d12 = e1.dot(e2), d22 = e2.dot(e2), dp1 = p.dot(e1), dp2 = p.dot(e2);
    const double det = d11 * d22 - d12 * d12;
    const double b1 = (d22 * dp1 - d12 * dp2) / det, b2 = (d11 * dp2 - d12 * dp1) / det;
    const double s = std::clamp(b1 + b2, 1e-9, 1 - 1e-9); // inverse of uniform_triangle()
    return {{between(choice_[point.emitter], choice_[point.emitter + 1], rng),
             between(before, before + triangles.probability(point.primitive), rng), s * s,
             std::clamp(b2 / s, 0.0, kBelowOne)}};
}

std::array<double, 2> EmitterInverse::ray(const SurfacePoint& point, const Vec3& w) const {
    const auto [sine2, around] = invert_hemisphere(Frame(point.ng).to_local(w));
    return {std::min(scene_->shapes()[point.shape].emission->profile.share_within(sine2), kBelowOne), around};
}

/// One number of a state, and what it was.
struct ReversibleJump::Edit {
    PrimaryStream* stream;
    std::size_t index;
    double value, old;
};

class ReversibleJump::Edits {
  public:
    explicit Edits(PrimaryState& state) : state_(&state) {}

    PrimaryState& state() const { return *state_; }
    /// Numbers that are used no more are drawn anew: nothing may remember them.
    template <std::size_t N>
    void set(PrimaryStream& stream, std::size_t first, const std::array<double, N>& numbers, bool used, Rng& rng) {
        for (std::size_t i = 0; i < N; ++i)
            edits_.push_back({&stream, first + i, used ? numbers[i] : rng.next(), stream.value(first + i)});
    }
    void apply() {
        for (const Edit& e : edits_) e.stream->set(e.index, e.value);
    }
    void undo() {
        for (const Edit& e : edits_) e.stream->set(e.index, e.old);
    }

  private:
    PrimaryState* state_;
    InlineVector<Edit, std::size_t{6} * (kMaxScatterings + 4)>
        edits_; // three numbers of each vertex in either sub-path
};

/// The numbers with which eye vertex j finds vertex j + 1.
bool ReversibleJump::set_eye_number(const Path& path, int j, bool used, Rng& rng, Edits& edits) const {
    PrimaryStream& stream = edits.state().eye();
    if (j == 0) {
        edits.set<2>(stream, 0, {path.image.x, path.image.y}, used, rng);
        return true;
    }
    const int i = path.vertices() - 1 - j;
    const auto u = invert_bsdf(path.x[i], leaving_direction(path, i, 1), leaving_direction(path, i, -1), rng);
    if (u) edits.set(stream, eye_bsdf(j), *u, used, rng);
    return u.has_value();
}

/// The numbers with which light vertex j finds vertex j + 1; j = -1: those of the emitter's point.
bool ReversibleJump::set_light_number(const Path& path, int j, bool used, Rng& rng, Edits& edits) const {
    PrimaryStream& stream = edits.state().light();
    const SurfacePoint& x0 = path.x[0].point;
    if (j == -1) {
        const auto u = emitters_->point(x0, rng);
        if (u) edits.set(stream, 0, *u, used, rng);
        return u.has_value();
    }
    if (j == 0) {
        if (!emitters_->point(x0, rng)) return false;
        edits.set(stream, kEmitterRay, emitters_->ray(x0, leaving_direction(path, 0, 1)), used, rng);
        return true;
    }
    // Other emitters ask for fewer numbers.
    if (x0.site != Site::surface) return false;
    const auto u = invert_bsdf(path.x[j], leaving_direction(path, j, -1), leaving_direction(path, j, 1), rng);
    if (u) edits.set(stream, light_bsdf(j), *u, used, rng);
    return u.has_value();
}

/// Collects what has to change from technique `from` to `to`, by their s. False where an inverse is missing, on either
/// side: the way back would need it.
bool ReversibleJump::edit(const Path& path, int from, int to, Rng& rng, Edits& edits) const {
    const int n = path.vertices(), low = std::min(from, to), high = std::max(from, to);
    for (int j = low - 1; j <= high - 2; ++j) // light vertices that one of the two continues from
        if (!set_light_number(path, j, to > from, rng, edits)) return false;
    for (int j = n - high - 1; j <= n - low - 2; ++j)
        if (!set_eye_number(path, j, to < from, rng, edits)) return false;
    edits.set<1>(edits.state().choice(), 0, {(to + rng.next()) / technique_count(scatterings_)}, true, rng);
    return true;
}

/// The state's connection. Its sub-paths are made again only where they aren't kept.
std::optional<Connection> ReversibleJump::connection(PrimaryState& state) const {
    SubPathPair& room = SubPathPair::scratch(state.sample().room());
    if (!state.path_is_kept()) {
        state.set_path_kept(true);
        return multiplexed_connection(*c_.scene, scatterings_, state.replay(), room);
    }
    auto source = state.replay();
    const Vec2 image = window_point(source.eye);
    const int s = chosen_technique(source.choice.next(), scatterings_);
    return Connection(*c_.scene, room.light, s, room.eye, technique_count(scatterings_) - s, image);
}

bool ReversibleJump::move(PrimaryState& state, Rng& rng, ChangeCounts& counts) const {
    ++counts.proposed;
    const int s = chosen_technique(state.choice().value(0), scatterings_),
              other = static_cast<int>(rng.below(static_cast<std::uint32_t>(technique_count(scatterings_))));
    if (other == s) return false;
    auto connection = this->connection(state);
    if (!connection || !connection->possible()) return false;
    connection->value(c_.heuristic);
    const double densities = connection->density_ratio(other), ratio = weight_ratio(densities, c_.heuristic);
    if (!accepts(acceptance(ratio), rng)) return false;
    Edits edits(state);
    if (!edit(connection->path(), s, other, rng, edits)) {
        ++counts.no_inverse;
        return false;
    }
    edits.apply();
    const double expected = state.target() * ratio / densities, made = state.rebuild();
    const bool same = std::abs(made - expected) <= 0.01 * expected;
    if (same) {
        state.adopt();
        ++counts.accepted;
    } else {
        edits.undo();
        ++counts.drifted;
    }
    return same;
}

} // namespace keyhole
