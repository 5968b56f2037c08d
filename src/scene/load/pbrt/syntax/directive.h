// The grammar of pbrt's text format: a file is a list of directives.
//
//     file      = { directive }
//     directive = NAME { number } { "word" } { parameter }        as the table in directive.cpp says for each name
//     parameter = "type name" value
//     value     = number | "string" | true | false | "[" { number } "]" | "[" { "string" } "]" | "[" { true|false } "]"
#pragma once

#include "core/error.h"
#include "scene/load/input.h"
#include "scene/load/pbrt/syntax/lexer.h"

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
    /// Enough of it for later messages.
    Directive head() const { return {name, position, {}, words, {}, {}}; }
    /// @throws InputError "file:line:column: title: message".
    [[noreturn]] void fail(const std::string& message) const;
    [[noreturn]] void fail(const Parameter& parameter, const std::string& message) const;
    /// For a mistake after which what follows can't be understood. @throws FatalInputError.
    [[noreturn]] void stop(const std::string& message) const;
    /// What a name stands for, `what` it should name as in "material". @throws UnknownName here.
    template <class Map> const auto& look_up(const Map& map, std::string_view what, const std::string& name) const {
        return look_up(map, what, name, position);
    }
    /// The same for a name in a parameter.
    template <class Map>
    const auto& look_up(const Map& map, std::string_view what, const std::string& name, const Parameter& user) const {
        return look_up(map, what, name, user.position);
    }

  private:
    template <class Map>
    const auto& look_up(const Map& map, std::string_view what, const std::string& name,
                        const FilePosition& where) const {
        const auto found = map.find(name);
        if (found != map.end()) return found->second;
        throw UnknownName(where, std::string(what) + " '" + name + "'", title() + ": " + unknown_name(what, name, map));
    }
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
    void pass_over_value(const Directive& directive);
    Parameter read_parameter(const Directive& directive);
    void read_values(const Directive& directive, Parameter& parameter);
    void read_value(const Directive& directive, Parameter& parameter, const Token& token);

    Lexer lexer_;
    std::optional<Token> begin_; ///< name of the next directive, where it was taken for a part of the last
    Token last_;                 ///< the last token taken
    int taken_ = 0;              ///< tokens since the name of the directive
};

} // namespace keyhole::pbrt
