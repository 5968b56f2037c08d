#include "methods/inspection/inspection.h"

#include <algorithm>
#include <bit>

namespace keyhole {
namespace {

constexpr std::size_t kMostRefused = 20'000;

std::array<float, 3> floats(const Vec3& p) { return {p.x, p.y, p.z}; }

PhotonSample::Map summary(const PhotonSet& set) {
    PhotonSample::Map map{set.main_photons.size(), set.pilots.size()};
    for (const Photon& p : set.main_photons) map.power += luminance(p.power());
    return map;
}

/// Of `all`, the share that is theirs where `part` of `whole` are.
std::size_t share_of(std::size_t all, std::size_t part, std::size_t whole) {
    return whole > all ? static_cast<std::size_t>(static_cast<double>(all) * static_cast<double>(part) /
                                                  static_cast<double>(whole))
                       : part;
}

/// Every n-th, so that at most `most` are left.
void thin(std::vector<Vec3>& places, std::size_t most) {
    if (places.size() <= most) return;
    for (std::size_t i = 0; i < most; ++i) places[i] = places[i * places.size() / most];
    places.resize(most);
}

} // namespace

PhotonRecorder::Key PhotonRecorder::key_of(const Photon& photon) {
    const Vec3 p = photon.position(), w = photon.direction();
    Key key;
    for (int i = 0; i < 3; ++i) {
        key[static_cast<std::size_t>(i)] = std::bit_cast<std::uint32_t>(p[i]);
        key[static_cast<std::size_t>(i) + 3] = std::bit_cast<std::uint32_t>(w[i]);
    }
    return key;
}

std::uint64_t PhotonRecorder::hash(const Key& key) {
    std::uint64_t h = 0;
    for (const std::uint32_t word : key) {
        h = (h ^ word) * 0x9e3779b97f4a7c15ULL;
        h ^= h >> 29;
    }
    return h;
}

bool PhotonRecorder::Origin::comes_before(const Origin& o) const {
    return std::ranges::lexicographical_compare(
        trail.points, o.trail.points,
        [](const TrailPoint& a, const TrailPoint& b) { return floats(a.p) < floats(b.p); });
}

void PhotonRecorder::stored(const Photon& photon, const PhotonOrigin& origin) {
    const Key key = key_of(photon);
    const std::uint64_t h = hash(key);
    Origin found{static_cast<int>(origin.photon) - 1, origin.emitter, origin.guided};
    if (h / kShards % kTrailsEvery == 0) found.trail = {{origin.trail.begin(), origin.trail.end()}, origin.photon};
    Shard& shard = shards_[h % kShards];
    const std::lock_guard lock(shard.mutex);
    const auto [at, added] = shard.origins.try_emplace(key, found);
    // Chains may come by the same place on paths that end elsewhere: which of them is first must not decide.
    if (!added && found.comes_before(at->second)) at->second = found;
}

void PhotonRecorder::thrown_away(const Vec3& p) {
    const std::uint64_t h = hash({std::bit_cast<std::uint32_t>(p.x), std::bit_cast<std::uint32_t>(p.y),
                                  std::bit_cast<std::uint32_t>(p.z), 0, 0, 0});
    Shard& shard = shards_[h % kShards];
    const std::lock_guard lock(shard.mutex);
    ++shard.refused;
    if (h / kShards % kRefusedEvery == 0) ++shard.refused_at[floats(p)];
}

const PhotonRecorder::Origin* PhotonRecorder::origin_of(const Photon& photon) {
    const Key key = key_of(photon);
    const auto& origins = shards_[hash(key) % kShards].origins;
    const auto at = origins.find(key);
    return at != origins.end() ? &at->second : nullptr;
}

void PhotonRecorder::add(std::span<const Photon> photons, std::size_t most, bool caustic, PhotonSample& out) {
    const std::size_t shown = std::min(most, photons.size());
    for (std::size_t i = 0; i < shown; ++i) {
        const Photon& photon = photons[i * photons.size() / shown];
        PhotonShown one{photon, caustic};
        if (const Origin* origin = origin_of(photon)) {
            one.guided = origin->guided;
            one.scatterings = origin->scatterings;
            one.emitter = origin->emitter;
            if (!origin->trail.points.empty()) {
                one.trail = static_cast<std::int32_t>(out.trails.size());
                out.trails.push_back(origin->trail);
            }
        }
        out.photons.push_back(one);
    }
}

PhotonSample PhotonRecorder::sample(const Photons& maps, std::size_t photons, std::size_t trails) {
    PhotonSample out;
    out.global = summary(maps.global);
    out.caustic = summary(maps.caustic);
    const std::size_t all = out.global.main_photons + out.caustic.main_photons;
    add(maps.global.main_photons, share_of(photons, out.global.main_photons, all), false, out);
    add(maps.caustic.main_photons, share_of(photons, out.caustic.main_photons, all), true, out);
    if (out.trails.size() > trails) {
        std::vector<PhotonTrail> kept;
        for (PhotonShown& p : out.photons) {
            if (p.trail < 0) continue;
            const auto at = static_cast<std::size_t>(p.trail), count = out.trails.size();
            const bool keep = (at + 1) * trails / count > at * trails / count;
            p.trail = keep ? static_cast<std::int32_t>(kept.size()) : -1;
            if (keep) kept.push_back(std::move(out.trails[at]));
        }
        out.trails = std::move(kept);
    }
    for (const Shard& shard : shards_) {
        out.refused += shard.refused;
        for (const auto& [p, times] : shard.refused_at) out.refused_at.emplace_back(p[0], p[1], p[2]);
    }
    thin(out.refused_at, kMostRefused);
    return out;
}

} // namespace keyhole
