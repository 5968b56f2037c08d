// Cost of building a photon map and of asking it. The surfaces are the six walls of a room with 5,000 small cards, so
// that queries meet big and small triangles, edges and corners.
#include "photonmap/importance/importance_map.h"
#include "photonmap/map_stores.h"
#include "scene/warp.h"

#include <benchmark/benchmark.h>

namespace keyhole {
namespace {

Rng make_rng(std::uint64_t index) { return {1, StreamPurpose::test, index}; }

Shape parallelogram(const Vec3& corner, const Vec3& u, const Vec3& v) {
    TriangleMesh mesh;
    mesh.positions = {corner, corner + u, corner + u + v, corner + v};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    Shape shape;
    shape.geometry = std::move(mesh);
    return shape;
}

constexpr int kCards = 200;

const std::vector<Shape>& room() {
    static const std::vector<Shape> shapes = [] {
        std::vector<Shape> s;
        for (int axis = 0; axis < 3; ++axis) {
            Vec3 u(0), v(0), far(0);
            u[(axis + 1) % 3] = 4;
            v[(axis + 2) % 3] = 4;
            far[axis] = 4;
            s.push_back(parallelogram(Vec3(0), u, v));
            s.push_back(parallelogram(far, u, v));
        }
        Rng rng = make_rng(0);
        for (int i = 0; i < kCards; ++i) {
            const Vec3 p(static_cast<float>(4 * rng.next()), static_cast<float>(4 * rng.next()),
                         static_cast<float>(4 * rng.next()));
            const Frame frame(uniform_sphere(rng.next(), rng.next()));
            s.push_back(parallelogram(p, frame.s * 0.5f, frame.t * 0.5f));
        }
        return s;
    }();
    return shapes;
}

/// A point of the room: on a wall or a card with equal probability.
SurfaceRegion random_place(Rng& rng) {
    const std::uint32_t i = rng.next() < 0.5 ? rng.below(6) : 6 + rng.below(kCards);
    const auto& p = std::get<TriangleMesh>(room()[i].geometry).positions;
    const Vec3 u = p[1] - p[0], v = p[3] - p[0];
    return {p[0] + u * static_cast<float>(rng.next()) + v * static_cast<float>(rng.next()), u.cross(v).normalized()};
}

std::vector<Photon> photons(int n) {
    Rng rng = make_rng(1);
    std::vector<Photon> out;
    out.reserve(static_cast<std::size_t>(n));
    for (int i = 0; i < n; ++i) {
        const SurfaceRegion place = random_place(rng);
        const Frame frame(place.normal);
        out.emplace_back(place.position, place.normal, frame.to_world(cosine_hemisphere(rng.next(), rng.next())),
                         Rgb(1.0));
    }
    return out;
}

const PhotonMap& map() {
    static const PhotonMap m(photons(300'000));
    return m;
}

/// Places in the order of a camera's scan lines: photons of one leaf together.
std::vector<SurfaceRegion> places(bool coherent) {
    std::vector<SurfaceRegion> out;
    Rng rng = make_rng(2);
    for (int i = 0; i < 20'000; ++i) {
        if (!coherent) {
            out.push_back(random_place(rng));
            continue;
        }
        const auto j = static_cast<std::uint32_t>(static_cast<std::size_t>(i) * map().photons().size() / 20'000);
        out.push_back({map()[j].position(), map()[j].normal().decode()});
    }
    return out;
}

void BM_Build(benchmark::State& state) {
    for (auto _ : state) {
        PhotonMap m(photons(300'000));
        state.counters["bytes_per_photon"] = static_cast<double>(m.bytes()) / 300'000;
    }
}
BENCHMARK(BM_Build)->Unit(benchmark::kMillisecond);

void BM_Nearest(benchmark::State& state) {
    const auto queries = places(state.range(1) != 0);
    std::size_t i = 0;
    for (auto _ : state) {
        const SurfaceRegion& region = queries[i++ % queries.size()];
        benchmark::DoNotOptimize(map().nearest({region, 0.5f, static_cast<int>(state.range(0))}).radius2);
    }
    state.SetItemsProcessed(state.iterations());
}
BENCHMARK(BM_Nearest)->ArgNames({"k", "coherent"})->Args({60, 1})->Args({60, 0})->Args({20, 0});

/// The radius in mm: of 300,000 photons, 60 fill about 100 mm.
void BM_SurfaceArea(benchmark::State& state) {
    static const SurfacePatches patches(room());
    const auto queries = places(false);
    std::size_t i = 0;
    for (auto _ : state)
        benchmark::DoNotOptimize(
            patches.area(queries[i++ % queries.size()], static_cast<double>(state.range(0)) / 1000));
    state.SetItemsProcessed(state.iterations());
}
BENCHMARK(BM_SurfaceArea)->ArgName("mm")->Arg(10)->Arg(100);

void BM_Radiance(benchmark::State& state) {
    static const SurfacePatches patches(room());
    const auto queries = places(false);
    const auto brdf = [](const Photon& p) { return Rgb(p.direction().z > 0 ? 0.2 : 0.1); };
    std::size_t i = 0;
    for (auto _ : state) {
        const SurfaceRegion& region = queries[i++ % queries.size()];
        benchmark::DoNotOptimize(estimate_density(map(), {region, 0.5f, 60}, Unbiased::density,
                                                  state.range(0) != 0 ? &patches : nullptr, brdf));
    }
    state.SetItemsProcessed(state.iterations());
}
BENCHMARK(BM_Radiance)->ArgName("measured_area")->Arg(0)->Arg(1);

void BM_Deposit(benchmark::State& state) {
    const auto source = photons(100'000);
    PhotonStore store(10'000, 0, make_rng(3));
    std::size_t i = 0;
    for (auto _ : state) store.deposit(source[i++ % source.size()], 1.0);
    state.SetItemsProcessed(state.iterations());
}
BENCHMARK(BM_Deposit);

} // namespace
} // namespace keyhole

BENCHMARK_MAIN();
