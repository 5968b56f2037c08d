#include "scene/load/pbrt/importer.h"

#include <functional>

namespace keyhole::pbrt {
namespace {

/// The file lists columns of matrices that act on column vectors: the rows of ours, which act on row vectors.
Transform matrix(const std::vector<double>& n) {
    return {n[0], n[1], n[2], n[3], n[4], n[5], n[6], n[7], n[8], n[9], n[10], n[11], n[12], n[13], n[14], n[15]};
}

Transform translation(const Directive& d) {
    Transform t;
    return t.setTranslation(Imath::V3d(d.numbers[0], d.numbers[1], d.numbers[2]));
}

Transform scaling(const Directive& d) {
    Transform t;
    return t.setScale(Imath::V3d(d.numbers[0], d.numbers[1], d.numbers[2]));
}

Transform rotation(const Directive& d) {
    const Imath::V3d axis(d.numbers[1], d.numbers[2], d.numbers[3]);
    if (!(axis.length() > 0)) d.fail("found the axis 0 0 0, expected one with a length");
    Transform t;
    return t.setAxisAngle(axis.normalized(), d.numbers[0] * kPi / 180);
}

/// From the world to a camera that looks along +z, x to the right and y up: a left-handed space.
Transform look_at(const Directive& d) {
    const auto& n = d.numbers;
    const Imath::V3d eye(n[0], n[1], n[2]), view = Imath::V3d(n[3], n[4], n[5]) - eye, up(n[6], n[7], n[8]);
    if (!(view.length() > 0)) d.fail("found the eye at the place that it looks at, expected two places");
    const Imath::V3d forward = view.normalized(), right = up.normalized().cross(forward);
    if (!(right.length() > 1e-9)) d.fail("found the direction up along the view, expected another one");
    const Imath::V3d x = right.normalized(), y = forward.cross(x);
    return Transform(x.x, x.y, x.z, 0, y.x, y.y, y.z, 0, forward.x, forward.y, forward.z, 0, eye.x, eye.y, eye.z, 1)
        .inverse();
}

} // namespace

bool apply_transform(const Directive& d, Transform& to_world) {
    if (d.name == "Identity") {
        to_world = Transform();
        return true;
    }
    if (d.name == "Transform" || d.name == "ConcatTransform") {
        const Transform m = matrix(d.numbers);
        if (m[0][3] != 0 || m[1][3] != 0 || m[2][3] != 0 || m[3][3] == 0)
            d.fail("found a projective matrix, expected an affine one");
        const Transform affine = m * (1 / m[3][3]);
        to_world = d.name == "Transform" ? affine : affine * to_world;
        to_world[3][3] = 1;
        return true;
    }
    using Step = Transform (*)(const Directive&);
    static const std::map<std::string_view, Step> kSteps{
        {"Translate", translation}, {"Scale", scaling}, {"Rotate", rotation}, {"LookAt", look_at}};
    const auto step = kSteps.find(d.name);
    if (step == kSteps.end()) return false;
    to_world = step->second(d) * to_world;
    return true;
}

} // namespace keyhole::pbrt
