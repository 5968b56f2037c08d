#include "sampling/primary/primary_vector.h"

namespace keyhole {
namespace {

/// Delayed proposals shift the logarithm of a step by at most this share of its range: one octave.
constexpr double kMostShift = 1 / SmallStep::kOctaves;

} // namespace

void PrimaryStream::make_up_for_steps(Coordinate& c) {
    if (c.moved < clock_->last_large)
        c.value = rng_->next(); // whatever small steps followed, it would be uniform, and nothing depends on it yet
    else
        for (; c.moved < clock_->now; ++c.moved) c.value = wrap(c.value + SmallStep(rng_->next()).distance());
    c.moved = clock_->now;
}

double PrimaryStream::small(Coordinate& c) {
    c.first = rng_->next();
    c.attempt = clock_->attempt;
    return wrap(c.value + SmallStep(c.first).distance());
}

/// x + d - d', where d is the step of the first try and d' as long within a factor of two. Seen from the result, x + d
/// is as likely a first try as it was from x, and the shift between the two is symmetric: nothing but the targets
/// enters the acceptance.
double PrimaryStream::delayed(Coordinate& c) {
    if (clock_->after_large) return small(c);
    if (c.attempt != clock_->attempt) small(c);
    const SmallStep first(c.first), back = first.shifted(kMostShift * (2 * rng_->next() - 1));
    return wrap(c.value + first.distance() - back.distance());
}

double PrimaryStream::candidate(Coordinate& c) {
    if (clock_->step == Step::large) return rng_->next(); // whatever its value would be by now
    bring_up_to_date(c);
    switch (clock_->step) {
    case Step::small:
        return small(c);
    case Step::delayed:
        return delayed(c);
    case Step::large:
    case Step::stay:
        break;
    }
    return c.value;
}

void PrimaryStream::fill(std::span<double> numbers) {
    for (double& u : numbers) {
        if (used_ == coordinates_.size()) push(rng_->next());
        Coordinate& c = coordinates_[used_++];
        u = c.candidate = candidate(c);
    }
}

double PrimaryStream::value(std::size_t i) {
    while (coordinates_.size() <= i) push(rng_->next());
    bring_up_to_date(coordinates_[i]);
    return coordinates_[i].value;
}

void PrimaryStream::set(std::size_t i, double value) {
    this->value(i);
    coordinates_[i].value = value;
}

void PrimaryStream::accept() {
    for (std::size_t i = 0; i < used_; ++i) {
        coordinates_[i].value = coordinates_[i].candidate;
        coordinates_[i].moved = clock_->now + 1;
    }
}

} // namespace keyhole
