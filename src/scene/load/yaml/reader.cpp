#include "scene/load/yaml/reader.h"

#include "scene/load/input.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace keyhole {
namespace {

std::string describe(const YamlNode& node) {
    switch (node.kind) {
    case YamlNode::Kind::null:
        return "nothing";
    case YamlNode::Kind::list:
        return fmt::format("a list of {}", node.items.size());
    case YamlNode::Kind::map:
        return "a map";
    case YamlNode::Kind::scalar:
        break;
    }
    constexpr std::size_t kMost = 40;
    std::string text = node.text.substr(0, kMost);
    std::replace_if(
        text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20; }, ' ');
    if (node.text.size() > kMost) text += "...";
    return fmt::format("{} '{}'", node.quoted ? "the string" : "the value", text);
}

std::string in_words(const NumberRange& r) {
    constexpr double kHuge = std::numeric_limits<double>::max();
    std::string text(r.what);
    if (r.minimum > -kHuge) text += fmt::format(" {} {:g}", r.above_minimum ? "above" : "of at least", r.minimum);
    if (r.minimum > -kHuge && r.maximum < kHuge) text += " and";
    if (r.maximum < kHuge) text += fmt::format(" {} {:g}", r.below_maximum ? "below" : "at most", r.maximum);
    return text;
}

bool contains(const NumberRange& r, double x) {
    return (r.above_minimum ? x > r.minimum : x >= r.minimum) && (r.below_maximum ? x < r.maximum : x <= r.maximum);
}

} // namespace

void fail(const YamlNode& node, const std::string& message) { throw InputError(node.position(), message); }

void fail_expected(const YamlNode& node, std::string_view expected) {
    fail(node, fmt::format("found {}, expected {}", describe(node), expected));
}

double read_number(const YamlNode& node, const NumberRange& range) {
    if (node.kind != YamlNode::Kind::scalar || node.quoted) fail_expected(node, range.what);
    std::string_view text = node.text;
    if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
    double x = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), x);
    const bool whole = end == text.data() + text.size();
    if (error == std::errc::result_out_of_range && whole) fail_expected(node, in_words(range));
    if (error == std::errc{} && !whole) fail_expected(node, fmt::format("{}: a number alone", range.what));
    if (error != std::errc{}) fail_expected(node, range.what);
    if (!std::isfinite(x)) fail_expected(node, fmt::format("{} that is finite", range.what));
    if (!contains(range, x)) fail_expected(node, in_words(range));
    return x;
}

std::int64_t read_integer(const YamlNode& node, const NumberRange& range) {
    const double x = read_number(node, range);
    if (x != std::floor(x)) fail_expected(node, fmt::format("{} without a fraction", range.what));
    return static_cast<std::int64_t>(x);
}

bool read_bool(const YamlNode& node) {
    if (node.kind == YamlNode::Kind::scalar && !node.quoted) {
        if (node.text == "true") return true;
        if (node.text == "false") return false;
    }
    fail_expected(node, "true or false");
}

std::string read_string(const YamlNode& node, std::string_view expected) {
    if (node.kind != YamlNode::Kind::scalar || node.text.empty()) fail_expected(node, expected);
    return node.text;
}

std::string read_choice(const YamlNode& node, std::string_view what, const std::vector<std::string_view>& choices) {
    std::string word = read_string(node, what);
    if (std::find(choices.begin(), choices.end(), word) == choices.end())
        fail(node, fmt::format("found {}, {}", describe(node), expected_one_of(word, choices)));
    return word;
}

std::vector<double> read_numbers(const YamlNode& node, std::size_t count, const NumberRange& range) {
    if (node.kind != YamlNode::Kind::list || node.items.size() != count)
        fail_expected(node, fmt::format("a list of {} numbers", count));
    std::vector<double> numbers;
    for (const auto& item : node.items) numbers.push_back(read_number(*item, range));
    return numbers;
}

Imath::V3d read_vec3(const YamlNode& node, const NumberRange& range) {
    const auto n = read_numbers(node, 3, range);
    return {n[0], n[1], n[2]};
}

Rgb read_color(const YamlNode& node, const NumberRange& range) {
    if (node.kind == YamlNode::Kind::scalar) return Rgb(read_number(node, range));
    if (node.kind != YamlNode::Kind::list || node.items.size() != 3)
        fail_expected(node, fmt::format("{} for red, green and blue, or one number", range.what));
    const auto c = read_vec3(node, range);
    return {c.x, c.y, c.z};
}

const std::vector<YamlPtr>& read_list(const YamlNode& node, std::string_view what) {
    if (node.kind != YamlNode::Kind::list) fail_expected(node, fmt::format("a list of {}", what));
    return node.items;
}

const std::vector<YamlNode::Entry>& read_names(const YamlNode& node, std::string_view what) {
    if (node.kind != YamlNode::Kind::map) fail_expected(node, fmt::format("a map from names to {}", what));
    return node.entries;
}

MapReader::MapReader(const YamlNode& node, std::string_view what, const std::vector<std::string_view>& keys)
    : node_(node), what_(what) {
    if (node.kind != YamlNode::Kind::map)
        fail_expected(node, fmt::format("a map that describes {}, with keys of {}", what, fmt::join(keys, ", ")));
    for (const auto& [key, value] : node.entries)
        if (std::find(keys.begin(), keys.end(), key->text) == keys.end())
            fail(*key, fmt::format("found the unknown key '{}' in {}, {}", key->text, what,
                                   expected_one_of(key->text, keys)));
}

const YamlNode* MapReader::find(std::string_view key) const {
    for (const auto& entry : node_.entries)
        if (entry.key->text == key) return entry.value.get();
    return nullptr;
}

const YamlNode& MapReader::at(std::string_view key) const {
    const YamlNode* value = find(key);
    if (value == nullptr) fail(node_, fmt::format("found {} without '{}', expected that key", what_, key));
    return *value;
}

std::string read_type(const YamlNode& node, std::string_view what, const std::vector<std::string_view>& choices) {
    if (node.kind != YamlNode::Kind::map) fail_expected(node, fmt::format("a map that describes {}", what));
    for (const auto& [key, value] : node.entries)
        if (key->text == "type") return read_choice(*value, fmt::format("the type of {}", what), choices);
    fail(node, fmt::format("found {} without 'type', {}", what, expected_one_of("", choices)));
}

} // namespace keyhole
