// Whether two methods make the same picture: block-wise t-tests.
#pragma once

#include "core/settings.h"
#include "core/statistics.h"
#include "film/picture.h"
#include "scene/load/yaml/user_path_file.h"
#include "scene/scene.h"

#include <string>
#include <vector>

namespace keyhole::test {

/// Mean luminance of each 16 x 16 block, one entry an independent run.
using Blocks = std::vector<RunningStats>;

/// Blocks along a side of so many pixels, the last perhaps cut by the border.
int blocks_across(int pixels);

/// Mean luminance of each block, row by row.
std::vector<double> block_means(const Image& image);

/// Renders `runs` pictures of `scene` with consecutive seeds and collects the blocks of `layer`.
Blocks render_blocks(Scene& scene, Settings settings, int runs, const std::string& layer = "beauty",
                     const UserPathFile& user_paths = {});

struct Disagreement {
    int rejected = 0;         ///< blocks whose difference can't be chance, after Holm's correction
    double worst = 0;         ///< largest relative difference of a block
    double largest_error = 0; ///< largest relative standard error of a block of the first picture
    double ratio = 1;         ///< of mean brightness
    double ratio_error = 0;   ///< standard error of `ratio` by that of the first picture's blocks, taken as independent
    int noisy = 0;            ///< blocks of the first picture with a relative standard error above a quarter
    double quiet_ratio = 1;   ///< of mean brightness in the others
    std::string report;       ///< blocks that were rejected
};

/// Tests each block of `a` against `b` for a difference beyond `tolerance` times b (Welch's t-test, Holm's correction
/// at a family-wise level of 1 %).
Disagreement compare(const Blocks& a, const Blocks& b, double tolerance);

} // namespace keyhole::test
