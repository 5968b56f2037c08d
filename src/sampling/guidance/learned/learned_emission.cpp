#include "sampling/guidance/learned/learned_emission.h"

#include "scene/emitters/sphere_map.h"

#include <algorithm>
#include <array>

namespace keyhole {

namespace {

/// Of the choices of directions and of places, what goes on as if nothing had been learned.
constexpr double kPlain = 0.2;
/// So many lamps are seldom all worth the same.
constexpr std::size_t kManyEmitters = 12;
/// The same of emitters: one whose light is hard to find from the eye is seldom seen, and may matter all the same.
constexpr double kPlainEmitters = 0.5;
/// A path counts as so many times the mean at most: what was hard to find must not draw all light to where it was.
constexpr double kMostWeight = 20;
/// Directions among which one is chosen by resampling (Talbot, Cline and Egbert 2005).
constexpr std::size_t kCandidates = 8;
/// Of an octahedral map of directions: paths for a cell, and cells along a side.
constexpr double kPathsOfBeam = 48;
constexpr int kLeastSide = 4, kMostSide = 16;
/// Light is traced back to the plane of a beam along its own direction if that is as near to the beam's [cosine].
constexpr float kSameBeam = 0.5f;
/// With fewer paths the places of a beam are not learned.
constexpr std::size_t kLeastPaths = 12;
/// Directions that tell how much of an emitter's light lies in a cell, for each of them.
constexpr int kDirectionsOfCell = 64;

int cell_of(int side, const Vec3& towards) {
    const Vec2d place = sphere_place(SphereLayout::octahedral, towards);
    const auto along = [&](double x) { return std::clamp(static_cast<int>(x * side), 0, side - 1); };
    return along(place.y) * side + along(place.x);
}

Vec3 middle_of(int side, int cell) {
    return sphere_direction(SphereLayout::octahedral, {(cell % side + 0.5) / side, (cell / side + 0.5) / side});
}

/// What was found in the smallest square of cells, by halves of the map, that holds enough to learn from. Light of a
/// beam that found too little by itself would else come as if nothing were known of where it is wanted: seldom, and
/// with the power of the whole scene's cross-section.
std::vector<SeenLight> around(const std::vector<std::vector<SeenLight>>& by_cell, int side, int cell) {
    std::vector<SeenLight> found;
    for (int width = 2; found.size() < kLeastPaths && width < 2 * side; width *= 2) {
        found.clear();
        const int x0 = cell % side / width * width, y0 = cell / side / width * width;
        for (int y = y0; y < std::min(side, y0 + width); ++y)
            for (int x = x0; x < std::min(side, x0 + width); ++x) {
                const auto& here = by_cell[static_cast<std::size_t>(y * side + x)];
                found.insert(found.end(), here.begin(), here.end());
            }
    }
    return found;
}

/// Share of an emitter's light that comes from each cell.
std::vector<double> light_by_cell(const Emitter& emitter, int side) {
    std::vector<double> share(static_cast<std::size_t>(side) * static_cast<std::size_t>(side));
    const int count = kDirectionsOfCell * side * side;
    Rng rng(1, StreamPurpose::learned_emission, ~0ULL); // the emitter's own: no picture depends on the seed here
    for (int i = 0; i < count; ++i)
        share[static_cast<std::size_t>(cell_of(side, emitter.sample_point(rng).point.p))] += 1.0 / count;
    return share;
}

SurfacePoint point_on(std::uint32_t emitter, SurfacePoint point) {
    point.emitter = emitter;
    return point;
}

} // namespace

bool LearnedEmission::can_learn(const Scene& scene) {
    return scene.emitters().size() >= kManyEmitters ||
           std::ranges::any_of(scene.emitters(), [](const auto& e) { return e->site() == Site::infinite; });
}

LearnedEmission::LearnedEmission(const Scene& scene, std::vector<SeenLight> seen)
    : scene_(&scene), skies_(scene.emitters().size()) {
    choose_emitters(seen);
    std::ranges::stable_sort(seen, {}, &SeenLight::emitter);
    for (std::size_t begin = 0, end = 0; begin < seen.size(); begin = end) {
        while (end < seen.size() && seen[end].emitter == seen[begin].emitter) ++end;
        if (scene.emitter(seen[begin].emitter).site() == Site::infinite)
            learn_sky(seen[begin].emitter, std::span(seen).subspan(begin, end - begin));
    }
}

void LearnedEmission::choose_emitters(std::vector<SeenLight>& seen) {
    std::vector<double> shares(skies_.size());
    for (std::size_t i = 0; i < shares.size(); ++i)
        shares[i] = scene_->emitter_distribution().probability(static_cast<std::uint32_t>(i));
    double sum = 0, limited = 0;
    for (const SeenLight& s : seen) sum += s.weight;
    if (sum > 0) {
        const double most = kMostWeight * sum / static_cast<double>(seen.size());
        for (SeenLight& s : seen) limited += s.weight = std::min(s.weight, most);
        for (double& share : shares) share *= kPlainEmitters;
        for (const SeenLight& s : seen) shares[s.emitter] += (1 - kPlainEmitters) * s.weight / limited;
    }
    choice_ = EmitterDistribution(shares);
}

void LearnedEmission::learn_sky(std::uint32_t i, std::span<const SeenLight> found) {
    const Emitter& emitter = scene_->emitter(i);
    Sky& sky = skies_[i];
    if (!emitter.is_delta()) {
        const double side = std::sqrt(static_cast<double>(found.size()) / kPathsOfBeam);
        sky.side = std::clamp(static_cast<int>(side), kLeastSide, kMostSide);
    }
    const auto cells = static_cast<std::size_t>(sky.side) * static_cast<std::size_t>(sky.side);
    std::vector<std::vector<SeenLight>> by_cell(cells);
    const auto cell = [&](const Vec3& towards) { return sky.side == 1 ? 0 : cell_of(sky.side, towards); };
    double sum = 0;
    for (const SeenLight& f : found) {
        by_cell[static_cast<std::size_t>(cell(f.towards))].push_back(f);
        sum += f.weight;
    }
    const std::vector<double> light = sky.side == 1 ? std::vector<double>{1.0} : light_by_cell(emitter, sky.side);
    sky.beams.resize(cells);
    double mean = 0;
    for (std::size_t b = 0; b < cells; ++b) {
        Beam& beam = sky.beams[b];
        double own = 0;
        for (const SeenLight& f : by_cell[b]) own += f.weight;
        // Where the emitter seemed dark, some of its light may come all the same.
        const double of_all = std::max(light[b], 1.0 / (kDirectionsOfCell * static_cast<double>(cells)));
        beam.weight = kPlain + (1 - kPlain) * own / sum / of_all;
        mean += light[b] * beam.weight;
        beam.w = -(sky.side == 1 ? found.front().towards : middle_of(sky.side, static_cast<int>(b)));
        if (by_cell[b].size() >= kLeastPaths || sky.side == 1)
            learn_beam(beam, by_cell[b]);
        else
            learn_beam(beam, around(by_cell, sky.side, static_cast<int>(b)));
    }
    sky.mean_weight = mean;
}

void LearnedEmission::learn_beam(Beam& beam, std::span<const SeenLight> found) const {
    if (found.size() < kLeastPaths) return;
    // Places of light of other directions than the middle one are told apart best on a plane near those that count.
    Imath::V3d sum(0.0);
    for (const SeenLight& f : found) sum += Imath::V3d(f.p);
    beam.center = Vec3(sum / static_cast<double>(found.size()));
    const Frame frame(beam.w);
    std::vector<PlaneHistogram::Point> points;
    for (const SeenLight& f : found) {
        const Vec3 on_plane = f.p - beam.center;
        const float cosine = -f.towards.dot(beam.w);
        const Vec3 w = cosine > kSameBeam ? -f.towards / cosine : beam.w; // across the plane 1
        const Vec3 local = frame.to_local(on_plane - w * on_plane.dot(beam.w));
        points.push_back({{local.x, local.y}, f.weight});
    }
    beam.places = PlaneHistogram(points);
}

const LearnedEmission::Beam& LearnedEmission::beam_of(const Sky& sky, const Vec3& towards) const {
    return sky.beams[sky.side == 1 ? 0 : static_cast<std::size_t>(cell_of(sky.side, towards))];
}

std::optional<EmittedLight> LearnedEmission::sample(SampleSource& source) const {
    if (choice_.empty()) return std::nullopt;
    const std::uint32_t i = choice_.sample(source.next());
    const Emitter& emitter = scene_->emitter(i);
    if (!skies_[i].beams.empty()) return sample_sky(skies_[i], emitter, choice_.probability(i), i, source);
    const EmitterPoint point = emitter.sample_point(source);
    return emit_light(*scene_, point_on(i, point.point), choice_.probability(i) * point.pdf, source);
}

std::optional<EmittedLight> LearnedEmission::sample_sky(const Sky& sky, const Emitter& emitter, double probability,
                                                        std::uint32_t i, SampleSource& source) const {
    std::array<EmitterPoint, kCandidates> candidates;
    std::array<double, kCandidates> up_to{};
    const std::size_t count = sky.side == 1 ? 1 : kCandidates;
    double sum = 0;
    for (std::size_t k = 0; k < count; ++k) {
        candidates[k] = emitter.sample_point(source);
        up_to[k] = sum += beam_of(sky, candidates[k].point.p).weight;
    }
    std::size_t k = 0;
    if (count > 1) {
        const double u = source.next() * sum;
        while (k + 1 < count && u >= up_to[k]) ++k;
    }
    const Beam& beam = beam_of(sky, candidates[k].point.p);
    // The chosen one's density, where its power is concerned: resampling leaves the mean alone.
    const double pdf = candidates[k].pdf * beam.weight * static_cast<double>(count) / sum;
    const EmitterRay ray = sample_place(beam, emitter, candidates[k].point, source);
    return emit_along(*scene_, point_on(i, candidates[k].point), probability * pdf, ray);
}

PlaneHistogram::Place LearnedEmission::place_on(const Beam& beam, const Vec3& w, const Vec3& p) {
    const Vec3 from = p - beam.center;
    const Vec3 local = Frame(beam.w).to_local(from - w * (from.dot(beam.w) / w.dot(beam.w)));
    return {{local.x, local.y}};
}

EmitterRay LearnedEmission::sample_place(const Beam& beam, const Emitter& emitter, const SurfacePoint& point,
                                         SampleSource& source) const {
    const bool plain = beam.places.empty() || source.next() < kPlain;
    EmitterRay ray = emitter.sample_ray(point, source);
    if (beam.places.empty()) return ray;
    const BoundingSphere scene = scene_->bounding_sphere();
    const Frame frame(beam.w);
    const double cosine = ray.w.dot(beam.w), plain_pdf = ray.pdf;
    PlaneHistogram::Place place{};
    bool in_beam = true; // whether the plain choice could have made it
    if (plain) {
        place = place_on(beam, ray.w, ray.origin.p);
    } else {
        const double u0 = source.next();
        place = beam.places.sample(u0, source.next());
        const Vec3 x =
            beam.center + frame.to_world(Vec3(static_cast<float>(place.x[0]), static_cast<float>(place.x[1]), 0));
        const Vec3 offset = x - scene.center, across = offset - ray.w * offset.dot(ray.w);
        ray.origin.p = scene.center + across - ray.w * scene.radius; // before everything in the scene
        in_beam = across.length2() <= scene.radius * scene.radius;
    }
    ray.pdf = (in_beam ? kPlain * plain_pdf : 0) + (1 - kPlain) * beam.places.pdf(place) / cosine;
    return ray;
}

double LearnedEmission::density_ratio(const SurfacePoint& x0, const Vec3& w, const Vec3& p) const {
    const std::uint32_t i = x0.emitter;
    const double by_power = scene_->emitter_distribution().probability(i);
    const double ratio = by_power > 0 ? choice_.probability(i) / by_power : 0.0;
    const Sky& sky = skies_[i];
    if (sky.beams.empty()) return ratio;
    const Beam& beam = beam_of(sky, x0.p);
    const double of_beam = sky.side == 1 ? 1 : beam.weight / sky.mean_weight;
    if (beam.places.empty()) return ratio * of_beam;
    const PlaneHistogram::Place place = place_on(beam, w, p);
    const double plain = scene_->emitter(i).ray_pdf(x0, w), cosine = w.dot(beam.w);
    return ratio * of_beam * (kPlain + (1 - kPlain) * beam.places.pdf(place) / (cosine * plain));
}

double LearnedEmission::effective_emitters() const {
    double squares = 0;
    for (std::uint32_t i = 0; i < skies_.size(); ++i) squares += choice_.probability(i) * choice_.probability(i);
    return squares > 0 ? 1 / squares : 0;
}

std::size_t LearnedEmission::bytes() const {
    std::size_t sum = skies_.capacity() * sizeof(Sky);
    for (const Sky& sky : skies_) {
        sum += sky.beams.capacity() * sizeof(Beam);
        for (const Beam& beam : sky.beams) sum += beam.places.bytes();
    }
    return sum;
}

} // namespace keyhole
