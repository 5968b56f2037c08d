// Textures of pbrt's format.
#pragma once

#include "scene/pbrt/parameters.h"
#include "scene/texture.h"

#include <map>
#include <string>

namespace keyhole::pbrt {

/// The named textures of a scene. Spectra and numbers have names of their own.
class TextureTable {
  public:
    /// Reads a `Texture` directive: `imagemap`, `constant`, `scale`, `mix` or `checkerboard`. A name may be given anew.
    /// @throws InputError for other kinds, and for pictures that can't be read.
    void define(Parameters& parameters);

    /// A parameter that is a spectrum or names a texture.
    ColorTexture color(Parameters& parameters, std::string_view name, const Rgb& otherwise,
                       SpectrumUse use = SpectrumUse::reflectance) const;
    /// A parameter that is a number, within `bounds`, or names a texture; null where it is not given.
    FloatTexture find_number(Parameters& parameters, std::string_view name, const Bounds& bounds) const;
    FloatTexture number(Parameters& parameters, std::string_view name, double otherwise,
                        const Bounds& bounds = {}) const;

  private:
    template <class T> std::shared_ptr<const Texture<T>> read(Parameters& parameters) const;
    template <class T>
    std::shared_ptr<const Texture<T>> operand(Parameters& parameters, std::string_view name, double otherwise) const;

    std::map<std::string, ColorTexture> colors_;
    std::map<std::string, FloatTexture> numbers_;
};

} // namespace keyhole::pbrt
