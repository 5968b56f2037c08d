#include "film/errors/repeat_error.h"

#include "core/error.h"
#include "core/statistics.h"
#include "film/grey.h"

#include <cmath>
#include <limits>

namespace keyhole {
namespace {

Grey finite_grey(const Image& image, const Image& reference) {
    if (image.width != reference.width || image.height != reference.height)
        throw InputError("found pictures of different sizes, expected equal ones");
    Grey grey(image);
    for (double& y : grey.y)
        if (!std::isfinite(y)) y = 0;
    return grey;
}

} // namespace

RepeatError repeat_error(const std::vector<Image>& repeats, const Image& reference, const Image* second_reference) {
    const Grey r1 = finite_grey(reference, reference);
    const Grey r2 = second_reference != nullptr ? finite_grey(*second_reference, reference) : r1;
    Grey r = r1;
    for (std::size_t p = 0; p < r.y.size(); ++p) r.y[p] = (r1.y[p] + r2.y[p]) / 2;
    const std::vector<double> smoothed = smooth(r);
    const double mean_r = mean(r.y);

    std::vector<Grey> pictures;
    pictures.reserve(repeats.size());
    for (const Image& image : repeats) pictures.push_back(finite_grey(image, reference));
    const auto error_of = [&](const Grey& picture, std::size_t p) {
        return (picture.y[p] - r1.y[p]) * (picture.y[p] - r2.y[p]) / error_unit(smoothed[p], mean_r);
    };
    std::vector<double> errors(r.y.size(), 0.0);
    for (std::size_t p = 0; p < errors.size(); ++p)
        for (const Grey& picture : pictures) errors[p] += error_of(picture, p) / static_cast<double>(pictures.size());

    const std::vector<std::size_t> kept = without_outliers(errors);
    RepeatError result{.each = std::vector<double>(pictures.size(), 0.0)};
    const double share = 1 / static_cast<double>(kept.size());
    for (const std::size_t p : kept) {
        RunningStats values;
        for (std::size_t k = 0; k < pictures.size(); ++k) {
            result.each[k] += share * error_of(pictures[k], p);
            values.add(pictures[k].y[p]);
        }
        result.error += share * errors[p];
        result.variance += share * values.variance() / error_unit(smoothed[p], mean_r);
    }
    if (pictures.size() < 2) result.variance = std::numeric_limits<double>::quiet_NaN();
    result.bias = result.error - result.variance;
    return result;
}

} // namespace keyhole
