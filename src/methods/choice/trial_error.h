// How large the error of a method is, told by two independent renders of it.
#pragma once

#include "film/picture.h"

#include <span>
#include <string>
#include <vector>

namespace keyhole {

/// Parts of a picture, 4 x 4 of them, in which light may be missing.
constexpr int kTrialParts = 16;
/// Pixels of the blocks that tell what is common to neighbours.
constexpr int kTrialBlock = 16;

/// Two independent renders of a window by one method at equal cost: luminance, one channel, W/(m^2 sr).
struct TrialPictures {
    Image first, second;
    /// Whether what errs most is samples of pixels that are rare and bright, rather than places that photons blur.
    bool rare_samples = false;
    bool by_photons = false; ///< whatever they find lights all that is near: they bring no light in dots
};

/// Squared error of one of the two, relative to the picture (the measure of ImageError::relmse_trim), in parts that
/// fall differently with time and the number of pixels.
struct TrialError {
    double grain = 0;    ///< independent from pixel to pixel
    double blotches = 0; ///< common to blocks of 4 x 4 pixels
    double missing = 0;  ///< of parts of the picture that are darker than another method finds them, beyond chance
    double dots = 0;     ///< of light that another method finds everywhere, and this one in a few samples or chains
    double blur = 0;     ///< of light, by photons
};

/// The luminance of a layer: by default, of what is looked at.
Image luminance_of(const Picture& picture, const std::string& layer = "beauty");

/// By how much the variance of pixels, relative to their mean, is smaller in narrower ones, as far as it can't be
/// chance. Without the twentieth where it is largest: bright, rare samples say nothing of the rest.
double variance_less(const TrialPictures& wide, const TrialPictures& narrow);

/// The share of the grain of two renders that a part of their light has: 0 to 1.
double share_of_grain(const TrialPictures& part, const TrialPictures& whole);

/// The squared error, relative to the picture, that both renders of a method with photons share for blurring light
/// alike: the mean product of their differences from two renders by samples of pixels, which is that of what the
/// methods disagree in, for noise is independent. At least 0, less a standard error and what light may explain that
/// samples can't find. Where photons blur, they leave the mean of the picture alone.
double blur(const TrialPictures& photons, const TrialPictures& samples);

/// The share of the pixels in which any of them finds light.
double share_lit(std::span<const TrialPictures> methods);

/// One for each of the methods. The picture that errors are relative to is the mean of all, weighted by how well the
/// two renders of each agree. Two renders agree on what neither found: where all of a method's are darker than another
/// one can be, what is missing is an error. So is what most pixels lack though a few bright ones bring it: their mean
/// is right, and the picture dark with dots. All pictures have the same size.
std::vector<TrialError> trial_errors(std::span<const TrialPictures> methods);

} // namespace keyhole
