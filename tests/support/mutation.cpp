#include "support/mutation.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <vector>

namespace keyhole::test {
namespace {

const std::array<std::string, 30> kHostile{"nan",    "inf",         "-inf",       "0",      "-0",
                                           "-1",     "1e308",       "-1e308",     "1e-308", "1e38",
                                           "1e9",    "1e12",        "1e-9",       "1e-30",  "2147483648",
                                           "1e5000", "0x10",        "4294967295", "1e18",   "-9223372036854775808",
                                           "true",   "null",        "",           "[]",     "{}",
                                           "abc",    "[1, 2, nan]", "\"",         "~",      "../../x"};

/// Those may pass, and what comes of them is to be rendered.
const std::array<std::string, 12> kOdd{"0",    "-1",  "0.5",  "2",   "-0.001", "1e-4",
                                       "1e-7", "100", "1000", "1e5", "1e20",   "1e-30"};

bool is_numeric(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0 || c == '.' || c == '-'; }

/// Beginnings of the runs of characters for which `in` holds.
template <class In> std::vector<std::size_t> runs(const std::string& text, In in) {
    std::vector<std::size_t> found;
    for (std::size_t i = 0; i < text.size(); ++i)
        if (in(text[i]) && (i == 0 || !in(text[i - 1]))) found.push_back(i);
    return found;
}

/// Puts a hostile value, another such run of the text, or an odd number in place of a run of characters for which `in`
/// holds.
template <class In> void replace_run(std::string& text, Dice& dice, In in, bool numbers) {
    const auto found = runs(text, in);
    if (found.empty()) return;
    const auto end_of = [&](std::size_t at) {
        return static_cast<std::size_t>(
            std::find_if_not(text.begin() + static_cast<std::ptrdiff_t>(at), text.end(), in) - text.begin());
    };
    const std::size_t at = dice.of(std::span<const std::size_t>(found));
    const std::size_t other = dice.of(std::span<const std::size_t>(found));
    const std::size_t choice = dice.below(4);
    const std::string with = choice == 0             ? dice.of(std::span<const std::string>(kHostile))
                             : numbers && choice > 1 ? dice.of(std::span<const std::string>(kOdd))
                                                     : text.substr(other, end_of(other) - other);
    text.replace(at, end_of(at) - at, with);
}

/// Loses a line, doubles it, or swaps it with another.
void shuffle_lines(std::string& text, Dice& dice) {
    std::vector<std::string> lines;
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t end = std::min(text.find('\n', at), text.size() - 1) + 1;
        lines.push_back(text.substr(at, end - at));
        at = end;
    }
    if (lines.empty()) return;
    const std::size_t i = dice.below(lines.size()), k = dice.below(lines.size());
    switch (dice.below(3)) {
    case 0:
        lines[i].clear();
        break;
    case 1:
        lines[i] += lines[i];
        break;
    default:
        std::swap(lines[i], lines[k]);
    }
    text.clear();
    for (const std::string& line : lines) text += line;
}

void flip_byte(std::string& text, Dice& dice) {
    if (text.empty()) return;
    char& c = text[dice.below(text.size())];
    c = static_cast<char>(static_cast<unsigned char>(c) ^ (1U << dice.below(8)));
}

} // namespace

const std::string& bad_value(Dice& dice) {
    return dice.below(2) > 0 ? dice.of(std::span<const std::string>(kHostile))
                             : dice.of(std::span<const std::string>(kOdd));
}

std::string mistaken_text(std::string text, Dice& dice) {
    const auto is_letter = [](char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; };
    for (std::size_t n = 1 + dice.below(2); n > 0; --n) {
        switch (dice.below(16)) {
        case 0:
            text.resize(dice.below(text.size() + 1));
            break;
        case 1:
            flip_byte(text, dice);
            break;
        case 2:
        case 3:
            shuffle_lines(text, dice);
            break;
        case 4:
        case 5:
            replace_run(text, dice, is_letter, false);
            break;
        default:
            replace_run(text, dice, is_numeric, true);
        }
    }
    return text;
}

std::string mistaken_bytes(std::string bytes, Dice& dice) {
    switch (dice.below(4)) {
    case 0:
        bytes.resize(dice.below(bytes.size() + 1));
        break;
    case 1:
        bytes.erase(dice.below(bytes.size()), 1 + dice.below(16));
        break;
    default:
        for (std::size_t n = 1 + dice.below(8); n > 0; --n) flip_byte(bytes, dice);
    }
    return bytes;
}

} // namespace keyhole::test
