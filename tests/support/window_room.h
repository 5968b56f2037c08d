// A room that light enters by a window.
#pragma once

#include "scene/material.h"
#include "support/test_scenes.h"

namespace keyhole::test {

/// A room of 3 x 2.5 x 3 m whose only opening is a window of 0.8 x 0.8 m in the wall at z = 0. Emitters, camera
/// and window of the picture are left to the caller.
inline SceneMaker room_with_a_window(const MaterialPtr& wall = make_diffuse(Rgb(0.6))) {
    SceneMaker m;
    m.rectangle({0, 0, 0}, {0, 0, 3}, {3, 0, 0}, wall);
    m.rectangle({0, 2.5, 0}, {3, 0, 0}, {0, 0, 3}, wall);
    m.rectangle({3, 0, 3}, {-3, 0, 0}, {0, 2.5, 0}, wall);
    m.rectangle({0, 0, 3}, {0, 0, -3}, {0, 2.5, 0}, wall);
    m.rectangle({3, 0, 0}, {0, 0, 3}, {0, 2.5, 0}, wall);
    m.rectangle({0, 0, 0}, {3, 0, 0}, {0, 1, 0}, wall);
    m.rectangle({0, 1.8f, 0}, {3, 0, 0}, {0, 0.7f, 0}, wall);
    m.rectangle({0, 1, 0}, {1, 0, 0}, {0, 0.8f, 0}, wall);
    m.rectangle({1.8f, 1, 0}, {1.2f, 0, 0}, {0, 0.8f, 0}, wall);
    return m;
}

inline MaterialPtr ground_glass() { return make_dielectric(1.5, constant_texture(0.3), constant_texture(0.3)); }

/// Two faces, 2 cm apart, close before its window on the outside.
inline void add_pane(SceneMaker& m, const MaterialPtr& glass) {
    m.rectangle({0.9f, 0.9f, -0.07f}, {0, 1, 0}, {1, 0, 0}, glass);
    m.rectangle({0.9f, 0.9f, -0.05f}, {1, 0, 0}, {0, 1, 0}, glass);
}

} // namespace keyhole::test
