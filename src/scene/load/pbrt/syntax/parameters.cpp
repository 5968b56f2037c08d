#include "scene/load/pbrt/syntax/parameters.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>

namespace keyhole::pbrt {

std::string ReadContext::resolve(const std::string& path) const {
    return (std::filesystem::path(directory) / path).lexically_normal().string();
}

const Parameter* Parameters::find(std::string_view name) {
    known_.insert(std::string(name));
    for (const Parameter& p : directive_.parameters)
        if (p.name == name) return &p;
    if (inherited_ != nullptr)
        for (const Parameter& p : *inherited_)
            if (p.name == name) return &p;
    return nullptr;
}

const Parameter* Parameters::find(std::string_view name, std::initializer_list<std::string_view> types) {
    const Parameter* p = find(name);
    if (p != nullptr && std::find(types.begin(), types.end(), p->type) == types.end())
        directive_.fail(*p, fmt::format("found '{} {}', expected its type to be {}", p->type, name,
                                        fmt::join(types.begin(), types.end(), " or ")));
    return p;
}

const Parameter& Parameters::single(const Parameter& p, std::size_t values) const {
    const std::size_t n = p.numbers.size() + p.strings.size() + p.bools.size();
    if (n != values) directive_.fail(p, fmt::format("found {} values of '{}', expected {}", n, p.name, values));
    return p;
}

double Parameters::number(std::string_view name, double otherwise, const Bounds& bounds) {
    const Parameter* p = find(name, {"float", "integer"});
    if (p == nullptr) return otherwise;
    const double x = single(*p, 1).numbers[0];
    if (!(x >= bounds.least && x <= bounds.most))
        directive_.fail(
            *p, fmt::format("found {} as '{}', expected a number from {} to {}", x, name, bounds.least, bounds.most));
    return x;
}

std::int64_t Parameters::integer(std::string_view name, std::int64_t otherwise, std::int64_t least, std::int64_t most) {
    const Parameter* p = find(name, {"integer"});
    if (p == nullptr) return otherwise;
    const auto i = static_cast<std::int64_t>(single(*p, 1).numbers[0]);
    if (i < least || i > most)
        directive_.fail(*p,
                        fmt::format("found {} as '{}', expected a whole number from {} to {}", i, name, least, most));
    return i;
}

bool Parameters::boolean(std::string_view name, bool otherwise) {
    const Parameter* p = find(name, {"bool"});
    return p != nullptr ? single(*p, 1).bools[0] : otherwise;
}

std::string Parameters::string(std::string_view name, const std::string& otherwise) {
    const Parameter* p = find(name, {"string"});
    return p != nullptr ? single(*p, 1).strings[0] : otherwise;
}

Imath::V3d Parameters::point(std::string_view name, const Imath::V3d& otherwise) {
    const Parameter* p = find(name, {"point3", "vector3"});
    if (p == nullptr) return otherwise;
    const auto& n = single(*p, 3).numbers;
    return {n[0], n[1], n[2]};
}

Rgb Parameters::spectrum(std::string_view name, const Rgb& otherwise, ColorUse use) {
    const Parameter* p = find(name, {"rgb", "spectrum", "blackbody", "xyz"});
    if (p == nullptr) return otherwise;
    // Spectra may leave the gamut by a little without anybody's fault.
    const bool plain = p->type == "rgb" || (p->type == "spectrum" && p->numbers.size() == 1);
    const double most = plain && !p->numbers.empty() ? *std::ranges::max_element(p->numbers) : 0;
    if (use == ColorUse::reflectance && most > 1)
        warn("reflectance above 1",
             fmt::format("found {} in '{}', expected at most 1: what is above 1 counts as 1", most, name));
    return read_spectrum(directive_, *p, use, context_.directory);
}

std::vector<double> Parameters::numbers(std::string_view name, std::initializer_list<std::string_view> types) {
    const Parameter* p = find(name, types);
    return p != nullptr ? p->numbers : std::vector<double>();
}

void Parameters::ignore(std::initializer_list<std::string_view> names) {
    for (const auto name : names) known_.insert(std::string(name));
}

void Parameters::warn_of_the_rest() {
    const std::vector<std::string_view> known(known_.begin(), known_.end());
    for (const Parameter& p : directive_.parameters) {
        if (known_.contains(p.name)) continue;
        context_.warnings.add(p.position, "parameter " + directive_.title() + " " + p.name,
                              fmt::format("{}: '{} {}' means nothing here and is ignored{}", directive_.title(), p.type,
                                          p.name, did_you_mean(p.name, known)));
    }
}

void Parameters::warn(const std::string& kind, const std::string& message) {
    context_.warnings.add(directive_.position, kind, directive_.title() + ": " + message);
}

} // namespace keyhole::pbrt
