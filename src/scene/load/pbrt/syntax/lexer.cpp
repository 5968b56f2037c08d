#include "scene/load/pbrt/syntax/lexer.h"

#include <fmt/format.h>

#include <algorithm>

namespace keyhole::pbrt {
namespace {

bool is_space(char c) { return c == ' ' || c == '\n' || c == '\t' || c == '\r'; }
bool is_delimiter(char c) { return is_space(c) || c == '"' || c == '[' || c == ']' || c == '#'; }
bool is_control(char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }

/// Without bytes that would garble a terminal.
std::string printable(std::string_view text) {
    constexpr std::size_t kMost = 40;
    std::string s(text.substr(0, kMost));
    std::replace_if(s.begin(), s.end(), is_control, '?');
    return text.size() > kMost ? s + "..." : s;
}

} // namespace

void Lexer::skip_space() {
    for (; at_ < text_.size(); ++at_) {
        const char c = text_[at_];
        if (c == '#') at_ = std::min(text_.find('\n', at_), text_.size() - 1);
        if (text_[at_] == '\n') {
            ++line_;
            line_begin_ = at_ + 1;
        } else if (!is_space(text_[at_]) && c != '#') {
            return;
        }
    }
}

Token Lexer::read() {
    skip_space();
    Token token;
    token.line = line_;
    token.column = static_cast<int>(at_ - line_begin_) + 1;
    if (at_ >= text_.size()) return token;
    const char c = text_[at_];
    if (c == '"') return read_string(token);
    const std::size_t begin = at_++;
    token.kind = c == '[' ? Token::Kind::open : c == ']' ? Token::Kind::close : Token::Kind::word;
    if (token.kind == Token::Kind::word)
        while (at_ < text_.size() && !is_delimiter(text_[at_])) ++at_;
    token.text = std::string_view(text_).substr(begin, at_ - begin);
    const auto junk = std::find_if(token.text.begin(), token.text.end(), is_control);
    if (junk != token.text.end())
        throw InputError(position(token), fmt::format("found the byte {:#04x}, expected text",
                                                      static_cast<unsigned>(static_cast<unsigned char>(*junk))));
    return token;
}

Token Lexer::read_string(Token token) {
    token.kind = Token::Kind::string;
    const std::size_t begin = ++at_;
    for (; at_ < text_.size() && text_[at_] != '\n'; ++at_) {
        if (text_[at_] == '"') {
            token.text = std::string_view(text_).substr(begin, at_++ - begin);
            return token;
        }
        if (text_[at_] == '\\') ++at_;
    }
    at_ = std::min(at_, text_.size());
    throw InputError(position(token), fmt::format("found the string \"{}\" without an end, expected a closing quote",
                                                  printable(std::string_view(text_).substr(begin, at_ - begin))));
}

Token Lexer::next() {
    if (!has_peeked_) return read();
    has_peeked_ = false;
    return peeked_;
}

const Token& Lexer::peek() {
    if (!has_peeked_) peeked_ = read();
    has_peeked_ = true;
    return peeked_;
}

std::string unescape(std::string_view text) {
    std::string s;
    s.reserve(text.size());
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] != '\\' || i + 1 == text.size()) {
            s += text[i];
            continue;
        }
        constexpr std::string_view kLetters = "ntrbf", kMeanings = "\n\t\r\b\f";
        const char letter = text[++i];
        const std::size_t k = kLetters.find(letter);
        s += k == std::string_view::npos ? letter : kMeanings[k];
    }
    return s;
}

std::string describe(const Token& token) {
    switch (token.kind) {
    case Token::Kind::end:
        return "the end of the file";
    case Token::Kind::string:
        return fmt::format("the string \"{}\"", printable(token.text));
    default:
        return fmt::format("'{}'", printable(token.text));
    }
}

} // namespace keyhole::pbrt
