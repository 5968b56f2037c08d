#include "photonmap/kd_tree.h"

#include <algorithm>
#include <cmath>

namespace keyhole {
namespace {

struct Extent {
    Vec3 lower, upper;

    explicit Extent(std::span<const Photon> photons)
        : lower(photons.front().position()), upper(photons.front().position()) {
        for (const Photon& photon : photons) {
            const Vec3 p = photon.position();
            for (int k = 0; k < 3; ++k) {
                lower[k] = std::min(lower[k], p[k]);
                upper[k] = std::max(upper[k], p[k]);
            }
        }
    }
    int widest() const {
        const Vec3 d = upper - lower;
        return d.x >= d.y && d.x >= d.z ? 0 : d.y >= d.z ? 1 : 2;
    }
};

} // namespace

KdTree::KdTree(std::span<Photon> photons, std::uint32_t begin, std::uint32_t end, std::uint32_t leaf)
    : begin_(begin), end_(end) {
    if (begin == end) return;
    std::uint32_t leaves = 1;
    while ((end - begin + leaves - 1) / leaves > leaf) leaves *= 2;
    nodes_.resize(leaves - 1);
    const Extent all(photons.subspan(begin, end - begin));
    lower_ = all.lower;
    upper_ = all.upper;
    build(photons, {0, begin, end});
}

void KdTree::build(std::span<Photon> photons, const Place& at) {
    if (at.node >= nodes_.size()) return;
    const std::span<Photon> here = photons.subspan(at.begin, at.end - at.begin);
    const int axis = Extent(here).widest();
    const auto middle = here.begin() + static_cast<std::ptrdiff_t>(at.lower().end - at.begin);
    std::nth_element(here.begin(), middle, here.end(),
                     [axis](const Photon& a, const Photon& b) { return a.position()[axis] < b.position()[axis]; });
    nodes_[at.node] = {middle->position()[axis], static_cast<std::uint8_t>(axis)};
    build(photons, at.lower());
    build(photons, at.upper());
}

} // namespace keyhole
