#include "film/accumulation_buffer.h"

#include "core/error.h"

namespace keyhole {
namespace {

/// Black in the layers that can be drawn to.
Picture black(int width, int height) {
    Picture picture;
    picture.width = width;
    picture.height = height;
    for (const char* layer :
         {"beauty", "direct", "indirect", "caustic", "noise.direct", "noise.indirect", "noise.caustic"})
        picture.layers[layer] = Image(width, height, 3);
    return picture;
}

template <class Part>
void set(std::optional<Part>& part, const char* name, const std::map<std::string, AccumulatorState>& sums) {
    const auto words = sums.find(name);
    if (part.has_value() != (words != sums.end())) throw InputError("found the sums of another method");
    if (part) part->set_words(words->second);
}

} // namespace

AccumulationBuffer::AccumulationBuffer(int width, int height, const PixelFilter& filter, Parts parts)
    : width_(width), height_(height) {
    if (parts != Parts::drawn) film.emplace(width, height, filter);
    if (parts != Parts::film) drawn.emplace(width, height);
}

void AccumulationBuffer::merge(const AccumulationBuffer& other) {
    if (film && other.film) film->merge(*other.film);
    if (drawn && other.drawn) drawn->merge(*other.drawn);
}

void AccumulationBuffer::clear() {
    if (film) film->clear();
    if (drawn) drawn->clear();
}

Picture AccumulationBuffer::to_picture() const {
    Picture picture = film ? film->to_picture() : black(width_, height_);
    if (drawn) drawn->add_to(picture);
    return picture;
}

std::map<std::string, AccumulatorState> AccumulationBuffer::sums() const {
    std::map<std::string, AccumulatorState> sums;
    if (film) sums["samples"] = film->words();
    if (drawn) sums["drawn"] = drawn->words();
    return sums;
}

void AccumulationBuffer::set_sums(const std::map<std::string, AccumulatorState>& sums) {
    set(film, "samples", sums);
    set(drawn, "drawn", sums);
}

} // namespace keyhole
