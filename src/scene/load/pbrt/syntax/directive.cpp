#include "scene/load/pbrt/syntax/directive.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <map>
#include <utility>

namespace keyhole::pbrt {
namespace {

struct Form {
    std::size_t numbers = 0;
    std::size_t least_words = 0, most_words = 0;
    bool parameters = false;
};

const std::map<std::string_view, Form>& forms() {
    static const auto table = [] {
        using Names = std::initializer_list<std::string_view>;
        std::map<std::string_view, Form> forms{
            {"Rotate", {4, 0, 0, false}},          {"LookAt", {9, 0, 0, false}}, {"TransformTimes", {2, 0, 0, false}},
            {"MediumInterface", {0, 1, 2, false}}, {"Option", {0, 1, 1, false}}, {"Texture", {0, 3, 3, true}}};
        for (const auto name : Names{"AttributeBegin", "AttributeEnd", "Identity", "ObjectEnd", "ReverseOrientation",
                                     "TransformBegin", "TransformEnd", "WorldBegin", "WorldEnd"}) // the last: v3
            forms[name] = {};
        for (const auto name : Names{"Scale", "Translate"}) forms[name] = {3, 0, 0, false};
        for (const auto name : Names{"ConcatTransform", "Transform"}) forms[name] = {16, 0, 0, false};
        for (const auto name : Names{"ActiveTransform", "ColorSpace", "CoordinateSystem", "CoordSysTransform", "Import",
                                     "Include", "NamedMaterial", "ObjectBegin", "ObjectInstance"})
            forms[name] = {0, 1, 1, false};
        for (const auto name : Names{"Accelerator", "AreaLightSource", "Attribute", "Camera", "Film", "Integrator",
                                     "LightSource", "MakeNamedMaterial", "MakeNamedMedium", "Material", "PixelFilter",
                                     "Sampler", "Shape", "SurfaceIntegrator"}) // the last: v2 and v3 betas
            forms[name] = {0, 1, 1, true};
        return forms;
    }();
    return table;
}

enum class Values { integers, numbers, strings, bools, spectrum };
struct Type {
    std::string_view canonical;
    Values values;
    std::size_t components; ///< numbers come in multiples of this
};

/// v4's types, and v3's names for them.
const std::map<std::string_view, Type>& types() {
    static const auto table = [] {
        std::map<std::string_view, Type> types{{"integer", {"", Values::integers, 1}},
                                               {"spectrum", {"", Values::spectrum, 2}},
                                               {"string", {"", Values::strings, 1}},
                                               {"texture", {"", Values::strings, 1}},
                                               {"bool", {"", Values::bools, 1}}};
        for (const auto name : {"float", "blackbody"}) types[name] = {"", Values::numbers, 1};
        for (const auto name : {"point2", "vector2"}) types[name] = {"", Values::numbers, 2};
        for (const auto name : {"point3", "vector3", "normal", "rgb", "xyz"}) types[name] = {"", Values::numbers, 3};
        for (auto& [name, type] : types) type.canonical = name;
        const auto v3 = {std::pair{"normal3", "normal"}, {"point", "point3"}, {"vector", "vector3"}, {"color", "rgb"}};
        for (const auto& [old, name] : v3) types[old] = types.at(name);
        return types;
    }();
    return table;
}

std::optional<double> parse_number(std::string_view text) {
    if (text.starts_with('+')) text.remove_prefix(1); // from_chars() knows no plus sign
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (end != text.data() + text.size() || error == std::errc::invalid_argument) return std::nullopt;
    // Too small for a double is zero, too large infinite; from_chars() doesn't say which.
    if (error == std::errc::result_out_of_range) return std::strtod(std::string(text).c_str(), nullptr);
    return value;
}

/// The form of the directive that a token begins; the end of forms() for other tokens.
auto form_of(const Token& token) { return token.kind == Token::Kind::word ? forms().find(token.text) : forms().end(); }

bool is_words(std::string_view directive) { return directive == "ActiveTransform"; }

} // namespace

std::string Directive::title() const { return words.empty() ? name : fmt::format("{} \"{}\"", name, words.back()); }

void Directive::fail(const std::string& message) const {
    throw InputError(position, fmt::format("{}: {}", title(), message));
}

void Directive::fail(const Parameter& parameter, const std::string& message) const {
    throw InputError(parameter.position, fmt::format("{}: {}", title(), message));
}

void Directive::stop(const std::string& message) const {
    throw FatalInputError(position, fmt::format("{}: {}", title(), message));
}

std::optional<Directive> DirectiveReader::next() {
    const Token token = begin_ ? *std::exchange(begin_, std::nullopt) : lexer_.next();
    taken_ = 0;
    if (token.kind == Token::Kind::end) return std::nullopt;
    const auto form = form_of(token);
    if (form == forms().end()) {
        const std::string hint = token.kind == Token::Kind::word ? did_you_mean(token.text, keys_of(forms())) : "";
        throw InputError(lexer_.position(token),
                         fmt::format("found {}, expected a directive{}", describe(token), hint));
    }
    Directive directive;
    directive.name = token.text;
    directive.position = lexer_.position(token);
    read_numbers(directive, form->second.numbers);
    while (directive.words.size() < form->second.most_words) {
        const Token& word = lexer_.peek();
        const bool fits = word.kind == (is_words(directive.name) ? Token::Kind::word : Token::Kind::string);
        if (!fits && directive.words.size() >= form->second.least_words) break;
        if (!fits)
            throw InputError(lexer_.position(word),
                             fmt::format("{}: found {}, expected a name in quotes", directive.title(), describe(word)));
        directive.words.push_back(unescape(take().text));
    }
    if (directive.name == "Option") pass_over_value(directive);
    while (form->second.parameters && lexer_.peek().kind == Token::Kind::string) {
        Parameter parameter = read_parameter(directive);
        const auto same = std::ranges::find(directive.parameters, parameter.name, &Parameter::name);
        if (same == directive.parameters.end()) {
            directive.parameters.push_back(std::move(parameter));
        } else {
            directive.overruled.push_back(std::exchange(*same, std::move(parameter)));
        }
    }
    return directive;
}

void DirectiveReader::skip_to_directive() {
    if (taken_ > 0 && form_of(last_) != forms().end()) {
        begin_ = last_;
        return;
    }
    for (;;) {
        try {
            const Token& token = lexer_.peek();
            if (token.kind == Token::Kind::end || form_of(token) != forms().end()) return;
            lexer_.next();
        } catch (const InputError&) { // one message is enough for what is passed over
        }
    }
}

Token DirectiveReader::take() {
    ++taken_;
    return last_ = lexer_.next();
}

double DirectiveReader::read_number(const Directive& directive) {
    const Token token = take();
    const auto value = token.kind == Token::Kind::word ? parse_number(token.text) : std::nullopt;
    if (!value || !std::isfinite(*value))
        throw InputError(lexer_.position(token),
                         fmt::format("{}: found {}, expected a finite number", directive.title(), describe(token)));
    return *value;
}

/// Brackets around the numbers are optional, as pbrt has them around matrices.
void DirectiveReader::read_numbers(Directive& directive, std::size_t count) {
    if (count == 0) return;
    const bool bracketed = lexer_.peek().kind == Token::Kind::open;
    if (bracketed) take();
    for (std::size_t i = 0; i < count; ++i) directive.numbers.push_back(read_number(directive));
    if (!bracketed) return;
    const Token token = take();
    if (token.kind != Token::Kind::close)
        throw InputError(lexer_.position(token), fmt::format("{}: found {} after {} numbers, expected ']'",
                                                             directive.title(), describe(token), count));
}

/// One value, in brackets or not, which the name before it has without a type: Option "disablepixeljitter" true.
void DirectiveReader::pass_over_value(const Directive& directive) {
    Token token = take();
    const bool bracketed = token.kind == Token::Kind::open;
    if (bracketed) token = take();
    if ((token.kind != Token::Kind::word && token.kind != Token::Kind::string) || form_of(token) != forms().end())
        throw InputError(lexer_.position(token),
                         fmt::format("{}: found {}, expected a value", directive.title(), describe(token)));
    if (bracketed && take().kind != Token::Kind::close)
        throw InputError(lexer_.position(last_),
                         fmt::format("{}: found {}, expected ']'", directive.title(), describe(last_)));
}

Parameter DirectiveReader::read_parameter(const Directive& directive) {
    const Token declaration = take();
    Parameter parameter;
    parameter.position = lexer_.position(declaration);
    const std::string text = unescape(declaration.text);
    const auto fail = [&](const std::string& message) { directive.fail(parameter, message); };
    constexpr const char* kSpace = " \t";
    const std::size_t begin = std::min(text.find_first_not_of(kSpace), text.size());
    const std::size_t end = std::min(text.find_first_of(kSpace, begin), text.size());
    const std::size_t name = std::min(text.find_first_not_of(kSpace, end), text.size());
    const std::string type = text.substr(begin, end - begin);
    parameter.name = text.substr(name, text.find_last_not_of(kSpace) + 1 - std::min(name, text.size()));
    if (type.empty() || parameter.name.empty())
        fail(fmt::format("found {}, expected the type and the name of a parameter, as in \"float radius\"",
                         describe(declaration)));
    const auto known = types().find(type);
    if (known == types().end())
        fail(fmt::format("found the type '{}', {}", type, expected_one_of(type, keys_of(types()))));
    parameter.type = known->second.canonical;
    read_values(directive, parameter);
    return parameter;
}

void DirectiveReader::read_values(const Directive& directive, Parameter& parameter) {
    const Token first = take();
    if (first.kind == Token::Kind::open) {
        for (Token token = take(); token.kind != Token::Kind::close; token = take())
            read_value(directive, parameter, token);
    } else {
        read_value(directive, parameter, first);
    }
    const Type& type = types().at(parameter.type);
    const std::size_t count = parameter.numbers.size();
    if (count + parameter.strings.size() + parameter.bools.size() == 0)
        directive.fail(parameter, fmt::format("found no value of '{}', expected one", parameter.name));
    const bool whole = type.values == Values::spectrum && count == 1 ? false : count % type.components == 0;
    if (!whole)
        directive.fail(parameter, fmt::format("found {} numbers in '{} {}', expected a multiple of {}", count,
                                              parameter.type, parameter.name, type.components));
}

void DirectiveReader::read_value(const Directive& directive, Parameter& parameter, const Token& token) {
    const Values values = types().at(parameter.type).values;
    const auto fail = [&](std::string_view expected) {
        throw InputError(lexer_.position(token),
                         fmt::format("{}: found {} as '{} {}', expected {}", directive.title(), describe(token),
                                     parameter.type, parameter.name, expected));
    };
    if (values == Values::bools) {
        // v3 quotes them.
        if (token.text != "true" && token.text != "false") fail("true or false");
        parameter.bools.push_back(token.text == "true");
        return;
    }
    const bool is_string = token.kind == Token::Kind::string;
    if (values == Values::strings || (values == Values::spectrum && is_string)) {
        if (!is_string) fail("a string in quotes");
        if (!parameter.numbers.empty()) fail("a number");
        parameter.strings.push_back(unescape(token.text));
        return;
    }
    const auto number = token.kind == Token::Kind::word ? parse_number(token.text) : std::nullopt;
    if (!number || !std::isfinite(*number) || !parameter.strings.empty()) fail("a finite number");
    if (values == Values::integers && (*number != std::trunc(*number) || std::abs(*number) > 2147483647.0))
        fail("a whole number");
    parameter.numbers.push_back(*number);
}

} // namespace keyhole::pbrt
