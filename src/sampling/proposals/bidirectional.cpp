// BD, bidirectional: delete a sub-path, insert one of possibly other length, sampled from either end and joined (Veach
// 1997, section 11.2.1). It reaches every path that carries light: it alone makes a chain ergodic.
#include "core/integer_power.h"
#include "sampling/proposals/edit.h"
#include "sampling/proposals/registry.h"

#include <array>
#include <cmath>

namespace keyhole {
namespace {

class Bidirectional final : public Proposal<Path> {
  public:
    explicit Bidirectional(const ProposalContext& context)
        : scene_(*context.scene), set_(context.set), max_vertices_(context.max_scatterings + 2) {}

    std::string_view name() const override { return "bidirectional"; }
    double suitability(const Path& /*x*/) const override { return 1; }
    std::optional<Path> propose(const Path& x, Rng& rng, Failure& why) const override;
    double transition_density(const Path& x, const Path& y) const override;

  private:
    /// Calls visit(cut, weight) for every cut of x, shortest first for each light end.
    template <class Visit> void for_each_cut(const Path& x, Visit&& visit) const;
    static double cut_weight(int removed, bool everything);

    /// Numbers of vertices that may be inserted, as a closed range.
    std::array<int, 2> insertions(const Path& x, const Cut& cut) const;
    /// Probability of inserting `added` of them.
    double insertion_probability(const Path& x, const Cut& cut, int added) const;

    /// How many of `added` vertices may be traced from the light: 0 to this.
    static int most_from_light(const Path& x, const Cut& cut, int added) {
        return cut.eye == x.vertices() ? added - 1 : added;
    }

    std::optional<Cut> choose_cut(const Path& x, Rng& rng) const;
    int choose_insertion(const Path& x, const Cut& cut, Rng& rng) const;

    const Scene& scene_;
    PathSet set_;
    int max_vertices_;
};

double Bidirectional::cut_weight(int removed, bool everything) {
    constexpr double full = 0.3; // a fresh path now and then, whatever its length
    const double local = removed == 0 ? 0.3 : integer_power(0.6, removed - 1);
    return local + (everything ? full : 0);
}

template <class Visit> void Bidirectional::for_each_cut(const Path& x, Visit&& visit) const {
    const int n = x.vertices();
    for (int l = -1; l <= n - 2; ++l) {
        if (l >= 0 && !can_keep_light(scene_, x, l)) continue;
        for (int m = l + 1; m <= n; ++m) {
            if (m == 0 || m == n - 1) continue; // x0 is no camera sub-path, and the eye never stays alone
            if (m < n && !can_keep_eye(x, m)) continue;
            visit(Cut{l, m}, cut_weight(m - l - 1, l < 0 && m == n));
        }
    }
}

std::optional<Cut> Bidirectional::choose_cut(const Path& x, Rng& rng) const {
    double total = 0;
    for_each_cut(x, [&](const Cut&, double w) { total += w; });
    double left = rng.next() * total;
    std::optional<Cut> chosen;
    for_each_cut(x, [&](const Cut& cut, double w) {
        if (left < 0) return;
        left -= w;
        chosen = cut;
    });
    return chosen;
}

std::array<int, 2> Bidirectional::insertions(const Path& x, const Cut& cut) const {
    const int kept = x.vertices() - cut.removed();
    const int shortest = set_.everything ? 2 : 4; // L D D E and L S D E; L E
    const int ends = (cut.light < 0 ? 1 : 0) + (cut.eye == x.vertices() ? 1 : 0);
    // Nothing for nothing, or a pinhole for itself, is no proposal.
    const bool pinhole = cut.light == x.vertices() - 2 && !scene_.camera().has_lens();
    const int change = cut.removed() == 0 ? 1 : pinhole ? 2 : 0;
    return {std::max({ends, change, shortest - kept}), max_vertices_ - kept};
}

/// Relative frequency of a change of length.
double length_weight(int change) {
    constexpr std::array<double, 4> w{1.0, 0.4, 0.15, 0.07};
    const int j = std::abs(change);
    return j < 4 ? w[static_cast<std::size_t>(j)] : 0.07 * integer_power(0.5, j - 3);
}

double Bidirectional::insertion_probability(const Path& x, const Cut& cut, int added) const {
    const auto [least, most] = insertions(x, cut);
    if (added < least || added > most) return 0;
    double total = 0;
    for (int b = least; b <= most; ++b) total += length_weight(b - cut.removed());
    return length_weight(added - cut.removed()) / total;
}

int Bidirectional::choose_insertion(const Path& x, const Cut& cut, Rng& rng) const {
    const auto [least, most] = insertions(x, cut);
    double total = 0;
    for (int b = least; b <= most; ++b) total += length_weight(b - cut.removed());
    double left = rng.next() * total;
    for (int b = least; b < most; ++b)
        if ((left -= length_weight(b - cut.removed())) < 0) return b;
    return most;
}

std::optional<Path> Bidirectional::propose(const Path& x, Rng& rng, Failure& why) const {
    const auto cut = choose_cut(x, rng);
    if (!cut || insertions(x, *cut)[1] < insertions(x, *cut)[0]) return why = Failure::length, std::nullopt;
    const int n = x.vertices(), added = choose_insertion(x, *cut, rng);
    const int s = static_cast<int>(rng.below(static_cast<std::uint32_t>(most_from_light(x, *cut, added)) + 1));
    const int t = added - s;

    SubPath light, eye;
    for (int i = 0; i <= cut->light; ++i) light.push_back(x.x[i]);
    for (int i = n - 1; i >= cut->eye; --i) eye.push_back(x.x[i]);
    Vec2 image = x.image;

    for (int i = 0; i < s; ++i) {
        if (light.empty()) {
            const auto x0 = sample_emitter(scene_, rng);
            if (!x0) return why = Failure::no_light, std::nullopt;
            light.push_back(x0->vertex);
        } else if (!grow(scene_, light, From::light, image, i == 0, rng, why)) {
            return std::nullopt;
        }
    }
    for (int i = 0; i < t; ++i) {
        if (eye.empty()) {
            eye.push_back(sample_eye(scene_, rng));
            image.x = static_cast<float>(rng.next());
            image.y = static_cast<float>(rng.next());
        } else if (!grow(scene_, eye, From::eye, image, i == 0, rng, why)) {
            return std::nullopt;
        }
    }

    const bool hits_light = light.empty();
    if (hits_light && !eye.back().point.is_emitter()) return why = Failure::no_light, std::nullopt;
    if (!light.empty()) light.back().event = Event::finite;
    eye.back().event = Event::finite;
    auto y = join(scene_, set_, light, eye, image, why);
    if (y && added == cut->removed() && common_prefix(x, *y) == n) return why = Failure::unchanged, std::nullopt;
    return y;
}

double Bidirectional::transition_density(const Path& x, const Path& y) const {
    const int n = x.vertices();
    const Cut cut = cut_between(scene_, x, y);

    double total = 0, chosen = 0;
    for_each_cut(x, [&](const Cut& c, double w) {
        total += w;
        if (c.light == cut.light && c.eye == cut.eye) chosen = w;
    });
    const int added = y.vertices() - (n - cut.removed());
    if (chosen == 0 || added < 0) return 0;

    // Every number of vertices traced from the light could have made the same ones.
    const int first = cut.light + 1, most = most_from_light(x, cut, added);
    double from_eye = 1, sum = 0; // density of y[first + s .. first + added) traced from the eye
    std::array<double, kMaxScatterings + 3> eye_density{};
    for (int s = added; s >= 0; --s) {
        eye_density[static_cast<std::size_t>(s)] = from_eye;
        if (s > 0) from_eye *= y.x[first + s - 1].pdf_from_eye;
    }
    double from_light = 1;
    for (int s = 0; s <= most; ++s) {
        const int last = cut.light + s; // last vertex on the light's side of the connection
        const bool connection = last < 0 || joinable(y.x[last], y.x[last + 1]);
        if (connection) sum += from_light * eye_density[static_cast<std::size_t>(s)];
        if (s < most) from_light *= y.x[first + s].pdf_from_light;
    }
    return chosen / total * insertion_probability(x, cut, added) * sum / (most + 1);
}

} // namespace

constinit const ProposalKind proposals::bidirectional{
    .weight = {"bidirectional.weight", 0.4, 0, 1, "relative frequency of bidirectional proposals"},
    .family = kNewSubPaths,
    .make = [](const ProposalContext& context) { return only(std::make_unique<Bidirectional>(context)); }};

} // namespace keyhole
