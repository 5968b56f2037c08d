#include "sampling/proposals/cut.h"

#include "sampling/proposals/edit.h"

namespace keyhole {

bool can_keep_light(const Scene& scene, const Path& x, int i) {
    if (i == 0) return !scene.emitter(x.x[0].point.emitter).is_delta();
    return !x.x[i].specular();
}

Cut cut_between(const Scene& scene, const Path& x, const Path& y) {
    const int n = x.vertices();
    const int prefix = common_prefix(x, y), suffix = common_suffix(x, y, prefix);
    Cut cut{prefix - 1, suffix <= 1 ? n : n - suffix};
    while (cut.light >= 0 && !can_keep_light(scene, x, cut.light)) --cut.light;
    while (cut.eye < n && !can_keep_eye(x, cut.eye)) ++cut.eye;
    return cut;
}

} // namespace keyhole
