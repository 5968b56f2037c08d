#include "scene/load/pbrt/spectrum.h"

#include "scene/load/input.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <functional>
#include <map>

namespace keyhole::pbrt {
namespace {

using Curve = std::function<double(double)>; // over the wavelength [nm]

constexpr double kFirst = 360, kLast = 830, kStep = 1; // [nm]

double lobe(double x, double mean, double below, double above) {
    const double t = (x - mean) / (x < mean ? below : above);
    return std::exp(-t * t / 2);
}

/// The colour matching functions of the CIE 1931 observer, by the fits of Wyman, Sloan and Shirley (JCGT 2013).
Rgb observer(double w) {
    return {1.056 * lobe(w, 599.8, 37.9, 31.0) + 0.362 * lobe(w, 442.0, 16.0, 26.7) -
                0.065 * lobe(w, 501.1, 20.4, 26.2),
            0.821 * lobe(w, 568.8, 46.9, 40.5) + 0.286 * lobe(w, 530.9, 16.3, 31.1),
            1.217 * lobe(w, 437.0, 11.8, 36.0) + 0.681 * lobe(w, 459.0, 26.0, 13.8)};
}

/// Linear Rec. 709 from CIE XYZ.
Rgb to_rgb(const Rgb& xyz) {
    return {3.2404542 * xyz.x - 1.5371385 * xyz.y - 0.4985314 * xyz.z,
            -0.9692660 * xyz.x + 1.8760108 * xyz.y + 0.0415560 * xyz.z,
            0.0556434 * xyz.x - 0.2040259 * xyz.y + 1.0572252 * xyz.z};
}

Rgb integrate(const Curve& curve) {
    Rgb sum(0.0);
    for (double w = kFirst; w <= kLast; w += kStep) sum += observer(w) * (curve(w) * kStep);
    return sum;
}

struct Samples {
    std::vector<double> wavelengths, values; // wavelengths rise

    /// Linear in between; `outside` the range 0, or the nearest value.
    double at(double w, bool zero_outside) const {
        if (w <= wavelengths.front()) return w < wavelengths.front() && zero_outside ? 0.0 : values.front();
        if (w >= wavelengths.back()) return w > wavelengths.back() && zero_outside ? 0.0 : values.back();
        const auto i =
            static_cast<std::size_t>(std::upper_bound(wavelengths.begin(), wavelengths.end(), w) - wavelengths.begin());
        const double t = (w - wavelengths[i - 1]) / (wavelengths[i] - wavelengths[i - 1]);
        return values[i - 1] + t * (values[i] - values[i - 1]);
    }
};

/// CIE standard illuminant D65, every 20 nm.
const Samples& daylight() {
    static const Samples samples{
        {360, 380, 400, 420, 440, 460, 480, 500, 520, 540, 560, 580, 600, 620, 640, 660, 680, 700, 720, 740, 760, 780},
        {46.64, 49.98, 82.75, 93.43, 104.86, 117.81, 115.92, 109.35, 104.79, 104.41, 100.0,
         95.79, 90.01, 87.70, 83.70, 80.21,  78.28,  71.61,  61.60,  75.09,  46.42,  63.38}};
    return samples;
}

Rgb clamp_negative(const Rgb& c) { return {std::max(c.x, 0.0), std::max(c.y, 0.0), std::max(c.z, 0.0)}; }

/// A light's colour with luminance 1.
Rgb light_color(const Curve& curve) {
    const Rgb xyz = integrate(curve);
    return clamp_negative(to_rgb(xyz / xyz.y));
}

/// Each component relative to that of a white surface, so that a constant spectrum is grey to the last bit or so.
Rgb reflectance_color(const Samples& samples) {
    const Rgb white = to_rgb(integrate([](double w) { return daylight().at(w, true); }));
    const Rgb seen = to_rgb(integrate([&](double w) { return daylight().at(w, true) * samples.at(w, true); }));
    return clamp_negative({seen.x / white.x, seen.y / white.y, seen.z / white.z});
}

/// Refractive index and absorption of metals, integrated over the primaries' responses from measured data (Palik 1998;
/// Rakic 1998 for aluminium; Johnson and Christy 1972 for gold and copper). Oxides at the primaries' wavelengths.
const std::map<std::string_view, Rgb>& named_indices() {
    static const std::map<std::string_view, Rgb> table{{"metal-Ag-eta", {0.1552646, 0.1167233, 0.1383807}},
                                                       {"metal-Ag-k", {4.8283433, 3.1222460, 2.1470504}},
                                                       {"metal-Al-eta", {1.6574600, 0.8803690, 0.5212287}},
                                                       {"metal-Al-k", {9.2238692, 6.2695232, 4.8370012}},
                                                       {"metal-Au-eta", {0.1431190, 0.3749570, 1.4424786}},
                                                       {"metal-Au-k", {3.9831604, 2.3857207, 1.6032153}},
                                                       {"metal-Cu-eta", {0.2004377, 0.9240334, 1.1022120}},
                                                       {"metal-Cu-k", {3.9129485, 2.4528477, 2.1421880}},
                                                       {"metal-CuZn-eta", {0.444, 0.527, 1.094}},
                                                       {"metal-CuZn-k", {3.695, 2.765, 1.829}},
                                                       {"metal-MgO-eta", {1.735, 1.741, 1.749}},
                                                       {"metal-MgO-k", {0, 0, 0}},
                                                       {"metal-TiO2-eta", {2.584, 2.667, 2.794}},
                                                       {"metal-TiO2-k", {0, 0, 0}},
                                                       {"glass-BK7", {1.5151, 1.5195, 1.5235}},
                                                       {"glass-BAF10", {1.6670, 1.6741, 1.6811}},
                                                       {"glass-FK51A", {1.4855, 1.4884, 1.4913}},
                                                       {"glass-LASF9", {1.8449, 1.8594, 1.8744}},
                                                       {"glass-F5", {1.6667, 1.6799, 1.6941}},
                                                       {"glass-F10", {1.7230, 1.7380, 1.7550}},
                                                       {"glass-F11", {1.7786, 1.7955, 1.8150}}};
    return table;
}

/// Correlated colour temperatures [K] of the standard illuminants; the lamps' deviation from a black body is dropped.
const std::map<std::string_view, double>& named_lights() {
    static const std::map<std::string_view, double> table{
        {"stdillum-A", 2856},   {"stdillum-D50", 5003}, {"illum-acesD60", 6000}, {"stdillum-F1", 6430},
        {"stdillum-F2", 4230},  {"stdillum-F3", 3450},  {"stdillum-F4", 2940},   {"stdillum-F5", 6350},
        {"stdillum-F6", 4150},  {"stdillum-F7", 6500},  {"stdillum-F8", 5000},   {"stdillum-F9", 4150},
        {"stdillum-F10", 5000}, {"stdillum-F11", 4000}, {"stdillum-F12", 3000}};
    return table;
}

/// One spectrum in the making.
class SpectrumReader {
  public:
    SpectrumReader(const Directive& directive, const Parameter& parameter, ColorUse use, const std::string& directory)
        : directive_(directive), parameter_(parameter), use_(use), directory_(directory) {}

    Rgb read() const {
        const auto& n = parameter_.numbers;
        if (parameter_.type == "rgb" || parameter_.type == "xyz") {
            if (n.size() != 3) fail(fmt::format("found {} numbers, expected 3", n.size()));
            return checked(parameter_.type == "rgb" ? Rgb(n[0], n[1], n[2])
                                                    : clamp_negative(to_rgb({n[0], n[1], n[2]})));
        }
        if (parameter_.type == "blackbody") return blackbody();
        if (parameter_.type != "spectrum")
            fail("found a " + parameter_.type + ", expected an rgb, a spectrum or a blackbody");
        if (!parameter_.strings.empty()) return named(parameter_.strings.front());
        if (n.size() == 1) return checked(Rgb(n[0]));
        return sampled(n);
    }

  private:
    [[noreturn]] void fail(const std::string& message) const {
        directive_.fail(parameter_, fmt::format("'{}': {}", parameter_.name, message));
    }

    Rgb checked(const Rgb& c) const {
        const double most = use_ == ColorUse::reflectance ? 1.0 : 1e30;
        for (const double v : {c.x, c.y, c.z})
            if (!(v >= 0) || (use_ != ColorUse::reflectance && v > most))
                fail(fmt::format("found {}, expected a number that is not negative", v));
        return {std::min(c.x, most), std::min(c.y, most), std::min(c.z, most)};
    }

    Rgb blackbody() const {
        const double kelvin = parameter_.numbers.front();
        if (use_ == ColorUse::index || parameter_.numbers.size() > 2) fail("found a black body, expected a spectrum");
        if (!(kelvin >= 100 && kelvin <= 1e6)) fail(fmt::format("found {} kelvin, expected 100 to 1000000", kelvin));
        const double scale = parameter_.numbers.size() > 1 ? parameter_.numbers[1] : 1.0; // v3 has one here
        return checked(blackbody_color(kelvin) * scale);
    }

    Rgb named(const std::string& name) const {
        if (use_ == ColorUse::index)
            if (const auto found = named_indices().find(name); found != named_indices().end()) return found->second;
        if (use_ == ColorUse::light) {
            if (name == "stdillum-D65") return Rgb(1.0);
            if (const auto found = named_lights().find(name); found != named_lights().end())
                return blackbody_color(found->second);
        }
        const std::string path = (std::filesystem::path(directory_) / name).lexically_normal().string();
        std::error_code error;
        if (std::filesystem::is_regular_file(path, error)) return from_file(path);
        std::vector<std::string_view> names;
        for (const auto& [known, value] : named_indices())
            if (use_ == ColorUse::index) names.push_back(known);
        for (const auto& [known, value] : named_lights())
            if (use_ == ColorUse::light) names.push_back(known);
        fail(fmt::format("found no spectrum and no file '{}', {}", name, expected_one_of(name, names)));
    }

    /// Pairs of wavelength and value, with `#` comments.
    Rgb from_file(const std::string& path) const {
        std::vector<double> numbers;
        Lexer lexer(read_text_file(path), path);
        for (Token token = lexer.next(); token.kind != Token::Kind::end; token = lexer.next()) {
            char* end = nullptr;
            const std::string word(token.text);
            numbers.push_back(std::strtod(word.c_str(), &end));
            if (word.empty() || *end != '\0' || !std::isfinite(numbers.back()))
                throw InputError(lexer.position(token), fmt::format("found {}, expected a number", describe(token)));
        }
        return sampled(numbers);
    }

    Rgb sampled(const std::vector<double>& numbers) const {
        if (numbers.size() % 2 != 0 || numbers.empty()) fail("found a wavelength without its value, expected pairs");
        Samples samples;
        for (std::size_t i = 0; i < numbers.size(); i += 2) {
            if (i > 0 && !(numbers[i] > samples.wavelengths.back()))
                fail(fmt::format("found the wavelength {} after {}, expected rising ones", numbers[i],
                                 samples.wavelengths.back()));
            if (!(numbers[i + 1] >= 0))
                fail(fmt::format("found {}, expected a number that is not negative", numbers[i + 1]));
            samples.wavelengths.push_back(numbers[i]);
            samples.values.push_back(numbers[i + 1]);
        }
        if (use_ == ColorUse::index)
            return {samples.at(kPrimaryWavelengths[0], false), samples.at(kPrimaryWavelengths[1], false),
                    samples.at(kPrimaryWavelengths[2], false)};
        if (use_ == ColorUse::reflectance) return checked(reflectance_color(samples));
        const Curve curve = [&](double w) { return samples.at(w, true); };
        if (!(integrate(curve).y > 0)) return Rgb(0.0);
        return checked(light_color(curve));
    }

    const Directive& directive_;
    const Parameter& parameter_;
    ColorUse use_;
    const std::string& directory_;
};

} // namespace

Rgb blackbody_color(double kelvin) {
    constexpr double kSecond = 1.438776877e7; // second radiation constant [nm K]
    // Relative to the radiance at 560 nm, so that nothing underflows.
    return light_color([&](double w) {
        return std::pow(560 / w, 5) * std::exp(kSecond / (560 * kelvin) - kSecond / (w * kelvin)) *
               (-std::expm1(-kSecond / (560 * kelvin)) / -std::expm1(-kSecond / (w * kelvin)));
    });
}

Rgb read_spectrum(const Directive& directive, const Parameter& parameter, ColorUse use, const std::string& directory) {
    return SpectrumReader(directive, parameter, use, directory).read();
}

} // namespace keyhole::pbrt
