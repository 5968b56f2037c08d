// Words, strings and brackets of pbrt's text format.
#pragma once

#include "core/error.h"

#include <memory>
#include <string>
#include <string_view>

namespace keyhole::pbrt {

struct Token {
    enum class Kind { word, string, open, close, end };

    Kind kind = Kind::end;
    std::string_view text; ///< of a word; of a string what stands between its quotes, escapes not resolved
    int line = 0, column = 0;
};

/// Splits a text into tokens. White space separates; `#` begins a comment that ends with its line.
class Lexer {
  public:
    Lexer(std::string text, std::string file) : text_(std::move(text)), file_(std::move(file)) {
        // A byte-order mark, which some editors write.
        if (text_.starts_with("\xEF\xBB\xBF")) text_.erase(0, 3);
    }
    Lexer(const Lexer&) = delete;
    Lexer& operator=(const Lexer&) = delete;

    /// The next token, which is then consumed; `end` for ever at the end. Its text lives as long as the lexer.
    /// @throws InputError for a string that doesn't end with its line, and for bytes that no text has.
    Token next();
    /// The next token, which stays.
    const Token& peek();

    FilePosition position(const Token& token) const { return {file_, token.line, token.column}; }
    const std::string& file() const { return file_; }

  private:
    void skip_space();
    Token read();
    Token read_string(Token token);

    std::string text_, file_;
    std::size_t at_ = 0, line_begin_ = 0;
    int line_ = 1;
    Token peeked_;
    bool has_peeked_ = false;
};

/// Resolves the escapes `\" \\ \' \n \t \r \b \f` of a string token.
std::string unescape(std::string_view text);

/// How a token reads in messages.
std::string describe(const Token& token);

} // namespace keyhole::pbrt
