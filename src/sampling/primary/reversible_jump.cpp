#include "sampling/primary/reversible_jump.h"

#include "sampling/markov/acceptance.h"

#include <cmath>

namespace keyhole {
namespace {

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
