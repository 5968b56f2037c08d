// The grammar of pbrt's text format: a file is a list of directives.
//
//     file      = { directive }
//     directive = NAME { number } { "word" } { parameter }        as the table in directive.cpp says for each name
//     parameter = "type name" value
//     value     = number | "string" | true | false | "[" { number } "]" | "[" { "string" } "]" | "[" { true|false } "]"
#pragma once

#include "core/error.h"
#include "scene/pbrt/lexer.h"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace keyhole::pbrt {

/// Values of a declared type. Numbers are finite and come in whole points, colours and the like.
struct Parameter {
    std::string type; ///< one of v4's names; v3's are translated ("color" to "rgb", "point" to "point3")
    std::string name;
    FilePosition position;
    std::vector<double> numbers;      ///< of all types but the next three
    std::vector<std::string> strings; ///< of string, texture, and spectra given by name
    std::vector<bool> bools;
};

struct Directive {
    std::string name;
    FilePosition position;
    std::vector<double> numbers;
    std::vector<std::string> words;
    std::vector<Parameter> parameters; ///< names are unique: of those given more than once the last
    std::vector<Parameter> overruled;  ///< those that another of their name came after

    /// As it begins in the file: `Shape "sphere"`.
    std::string title() const;
    /// @throws InputError "file:line:column: title: message".
    [[noreturn]] void fail(const std::string& message) const;
    [[noreturn]] void fail(const Parameter& parameter, const std::string& message) const;
    /// For a mistake after which what follows can't be understood. @throws FatalInputError.
    [[noreturn]] void stop(const std::string& message) const;
    /// @param name with what it should name. @throws UnknownName at `where`.
    [[noreturn]] void fail_unknown(const FilePosition& where, const std::string& name,
                                   const std::string& message) const;
};

/// Reads directives off a text, one at a time, so that a long file is never held as a whole.
class DirectiveReader {
  public:
    DirectiveReader(std::string text, std::string file) : lexer_(std::move(text), std::move(file)) {}

    /// None at the end of the file.
    /// @throws InputError "file:line:column: what was found, what was expected" for all that the grammar excludes.
    std::optional<Directive> next();
    /// After next() threw: goes on to where the next directive begins.
    void skip_to_directive();

    const std::string& file() const { return lexer_.file(); }

  private:
    /// The next token, which is then consumed.
    Token take();
    double read_number(const Directive& directive);
    void read_numbers(Directive& directive, std::size_t count);
    Parameter read_parameter(const Directive& directive);
    void read_values(const Directive& directive, Parameter& parameter);
    void read_value(const Directive& directive, Parameter& parameter, const Token& token);

    Lexer lexer_;
    std::optional<Token> begin_; ///< name of the next directive, where it was taken for a part of the last
    Token last_;                 ///< the last token taken
    int taken_ = 0;              ///< tokens since the name of the directive
};

} // namespace keyhole::pbrt
