#include "scene/load/yaml/settings_text.h"

#include "core/error.h"
#include "scene/load/input.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <concepts>

namespace keyhole {
namespace {

template <class T> std::optional<T> parse_all(std::string_view text) {
    T x{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), x);
    if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
    return x;
}

/// Takes the unit off the end of a number: k, M, G or T, bytes or not; KiB, MiB, GiB or TiB. @returns how much it is
double take_unit(std::string_view& text) {
    const auto ends_number = [](char c) { return (c >= '0' && c <= '9') || c == '.'; };
    for (const auto& [end, step] : {std::pair(std::string_view("iB"), 1024.0), {"B", 1000.0}, {"", 1000.0}}) {
        if (!text.ends_with(end)) continue;
        const std::string_view rest = text.substr(0, text.size() - end.size());
        const std::size_t unit =
            rest.empty() ? std::string_view::npos : std::string_view(step == 1024 ? "KMGT" : "kMGT").find(rest.back());
        if (unit != std::string_view::npos) {
            text = rest.substr(0, rest.size() - 1);
            return std::pow(step, static_cast<double>(unit + 1));
        }
        if (end == "B" && !rest.empty() && ends_number(rest.back())) {
            text = rest;
            return 1;
        }
    }
    return 1;
}

/// A whole number: 1000, 1e3 or 1k. None for anything else, and past 2^53, where doubles skip whole numbers.
std::optional<std::int64_t> parse_whole(std::string_view text) {
    if (const auto whole = parse_all<std::int64_t>(text)) return whole;
    const double factor = take_unit(text);
    const auto x = parse_all<double>(text);
    if (!x) return std::nullopt;
    // Rounded, because 1.1 M is not whole in doubles.
    const double scaled = *x * factor, rounded = std::round(scaled);
    if (!(std::abs(rounded) <= 0x1p53) || std::abs(scaled - rounded) > 1e-6) return std::nullopt;
    return static_cast<std::int64_t>(rounded);
}

/// Bounds of settings from here on are of memory [bytes].
constexpr std::int64_t kLeastMemory = 1 << 16;

/// A bound on a whole number as one would write it: those of memory in KiB, and so on.
std::string bound_text(std::int64_t bound, bool of_memory) {
    std::size_t unit = 0;
    for (; of_memory && unit < 3 && bound >= 1024 && bound % 1024 == 0; ++unit) bound /= 1024;
    return fmt::format("{}{}", bound, std::array{"", "KiB", "MiB", "GiB"}[unit]);
}

/// Visits the table of settings and parses the value of the one whose key matches.
struct Setter {
    const std::string& key;
    const std::string& value;
    bool found = false;
    std::optional<std::string> error;
    std::vector<std::string_view> keys;

    bool matches(const char* candidate) {
        keys.emplace_back(candidate);
        if (key != candidate) return false;
        found = true;
        return true;
    }
    void refuse(const std::string& expected) {
        error = fmt::format("found '{}' for '{}', {}", value.substr(0, 40), key, expected);
    }

    template <std::integral T>
    void operator()(const char* name, T& member, std::int64_t minimum, std::int64_t maximum, const char*) {
        if (!matches(name)) return;
        const auto x = parse_whole(value);
        if (!x || *x < minimum || *x > maximum)
            return refuse(fmt::format("expected a whole number from {}{}", bounds_text(minimum, maximum),
                                      minimum >= kLeastMemory ? ", as 32MiB or 32MB" : ""));
        member = static_cast<T>(*x);
    }
    void operator()(const char* name, double& member, double minimum, double maximum, const char*) {
        if (!matches(name)) return;
        const auto x = parse_all<double>(value);
        if (!x || !(*x >= minimum && *x <= maximum))
            return refuse("expected a number from " + bounds_text(minimum, maximum));
        member = *x;
    }
    void operator()(const char* name, AutoNumber& member, double minimum, double maximum, const char*) {
        if (!matches(name)) return;
        const auto x = value == "auto" ? std::nullopt : parse_all<double>(value);
        if (value != "auto" && (!x || !(*x >= minimum && *x <= maximum)))
            return refuse(fmt::format("expected a number from {}, or auto", bounds_text(minimum, maximum)));
        member.value = x;
    }
    template <Choice E> void operator()(const char* name, E& member, const char*) {
        if (!matches(name)) return;
        const auto words = words_of(member);
        if (const auto choice = choice_of<E>(value))
            member = *choice;
        else
            refuse(expected_one_of(value, {words.begin(), words.end()}));
    }
    void operator()(const char* name, const Method*& member, const char*) {
        if (!matches(name)) return;
        std::vector<std::string_view> names;
        for (const Method* method : all_methods()) {
            names.push_back(name_of(*method));
            if (names.back() == value) return void(member = method);
        }
        refuse(expected_one_of(value, names));
    }
    void operator()(const char* name, bool& member, const char*) {
        if (!matches(name)) return;
        const bool on = value == "true" || value == "on";
        if (!on && value != "false" && value != "off") return refuse("expected true or false");
        member = on;
    }
};

/// What a setting is called that once had another name; empty: this is no such name.
std::string new_name(const std::string& key) {
    if (key == "reach") return "gather_coverage";
    if (!key.starts_with("p_")) return {};
    for (const ProposalParameter* p : proposal_parameters())
        if (key.substr(2) + ".weight" == p->key) return p->key;
    return {};
}

} // namespace

std::string bounds_text(std::int64_t minimum, std::int64_t maximum) {
    const bool of_memory = minimum >= kLeastMemory;
    return fmt::format("{} to {}", bound_text(minimum, of_memory), bound_text(maximum, of_memory));
}

std::string bounds_text(double minimum, double maximum) { return fmt::format("{} to {}", minimum, maximum); }

std::optional<SettingError> set_setting(Settings& settings, const std::string& key, const std::string& value,
                                        std::string* warning) {
    if (const std::string now = new_name(key); !now.empty()) {
        if (warning != nullptr) *warning = fmt::format("the setting '{}' is called '{}' now", key, now);
        return set_setting(settings, now, value == "auto" ? "true" : value); // reach was `auto` or `off`
    }
    Setter setter{key, value, false, std::nullopt, {}};
    visit_settings(settings, setter);
    if (!setter.found)
        return SettingError{true, fmt::format("found the unknown setting '{}', {}", key.substr(0, 40),
                                              expected_one_of(key, setter.keys))};
    if (setter.error) return SettingError{false, *setter.error};
    return std::nullopt;
}

void apply_override(Settings& settings, const std::string& key_equals_value, std::vector<std::string>* warnings) {
    const auto equals = key_equals_value.find('=');
    if (equals == std::string::npos || equals == 0)
        throw InputError(fmt::format("found '{}', expected key=value", key_equals_value));
    std::string warning;
    const auto error =
        set_setting(settings, key_equals_value.substr(0, equals), key_equals_value.substr(equals + 1), &warning);
    if (error) throw InputError(error->message);
    if (key_equals_value.starts_with("spp=")) settings.keep_spp = true; // who names them means them
    if (!warning.empty() && warnings != nullptr) warnings->push_back(warning);
}

} // namespace keyhole
