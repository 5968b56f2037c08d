// Functions fit a screen, parameter lists stay short, folders too, and no name of a type is defined twice. What files
// hold is found by counting braces: enough for code that clang-format has been over.
#include "source_files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <regex>
#include <set>
#include <string_view>

namespace {

using keyhole::source_test::all_sources;
using keyhole::source_test::Source;
using keyhole::source_test::Strings;

constexpr std::size_t kMostLines = 60, kMostParameters = 6, kMostEntries = 30;

bool is_name(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

/// Comments, strings and directives made blank; lines stay where they are.
class Plain {
  public:
    explicit Plain(std::string text) : text_(std::move(text)) {
        for (std::size_t i = 0; i < text_.size();) i = after(i);
    }
    const std::string& text() const { return text_; }

  private:
    void blank(std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < std::min(end, text_.size()); ++i)
            if (text_[i] != '\n') text_[i] = ' ';
    }
    std::size_t blank_to(std::size_t i, const char* last, std::size_t from) {
        const std::size_t end = text_.find(last, from);
        const std::size_t next = end == std::string::npos ? text_.size() : end + std::string_view(last).size();
        blank(i, next);
        return next;
    }
    /// Past the token at i.
    std::size_t after(std::size_t i) {
        const std::string_view rest = std::string_view(text_).substr(i);
        if (rest.starts_with("//") || (rest[0] == '#' && (i == 0 || text_[i - 1] == '\n'))) {
            std::size_t end = text_.find('\n', i);
            while (rest[0] == '#' && end != std::string::npos && text_[end - 1] == '\\')
                end = text_.find('\n', end + 1);
            blank(i, end);
            return std::min(end, text_.size());
        }
        if (rest.starts_with("/*")) return blank_to(i, "*/", i + 2);
        if (rest.starts_with("R\"")) {
            const std::string end = ")" + text_.substr(i + 2, text_.find('(', i) - i - 2) + "\"";
            return blank_to(i, end.c_str(), i);
        }
        const bool separator = i > 0 && is_name(text_[i - 1]); // of digits
        if (rest[0] != '"' && (rest[0] != '\'' || separator)) return i + 1;
        std::size_t end = i + 1;
        while (end < text_.size() && text_[end] != rest[0]) end += text_[end] == '\\' ? 2 : 1;
        blank(i, end + 1);
        return end + 1;
    }
    std::string text_;
};

/// Parameters of the list that opens at `open`.
std::size_t parameters(std::string_view head, std::size_t open) {
    int depth = 0;
    std::size_t commas = 0;
    bool any = false;
    for (std::size_t i = open + 1; i < head.size(); ++i) {
        const char c = head[i];
        if (c == ')' && depth == 0) break;
        if (c == '(' || c == '<' || c == '{' || c == '[') ++depth;
        if (c == ')' || (c == '>' && head[i - 1] != '-') || c == '}' || c == ']') --depth;
        if (c == ',' && depth == 0) ++commas;
        any = any || std::isspace(static_cast<unsigned char>(c)) == 0;
    }
    return any ? commas + 1 : 0;
}

/// A function, or the declaration of one.
struct Function {
    std::string name;
    std::size_t lines = 0, parameters = 0;
};

/// What a file defines outside of functions.
class Outline {
  public:
    explicit Outline(const Source& source) : plain_(source.text()), text_(plain_.text()) { scope(""); }
    std::vector<Function> functions;
    Strings types; ///< with their namespaces; none of unnamed ones

  private:
    /// What stands at i and before the brace, parenthesis or semicolon that ends it.
    void scope(const std::string& spaces, bool in_type = false) {
        std::size_t start = i_;
        int parentheses = 0;
        for (; i_ < text_.size(); ++i_) {
            const char c = text_[i_];
            if (c == '(') ++parentheses;
            if (c == ')') --parentheses;
            if (parentheses > 0) {
                continue;
            } else if (c == '}') {
                return;
            } else if (c == ';') {
                head(start, 0);
                start = i_ + 1;
            } else if (c == '{') {
                if (open(start, spaces, in_type)) start = i_ + 1;
            }
        }
    }

    /// Goes past what the brace at i_ opens. False: a braced value amid a definition.
    bool open(std::size_t start, const std::string& spaces, bool in_type) {
        static const std::regex space(R"((?:^|\s)namespace\s*([\w:]*)\s*$)"),
            type(
                R"((?:^|[\s>])(?:struct|class|union|enum(?:\s+class)?)\s+(?:\[\[\w+\]\]\s*)?([\w:]+)\s*(?:final\s*)?(?::[^:(][^()]*)?$)");
        const std::string before = text_.substr(start, i_ - start);
        std::smatch m;
        if (std::regex_search(before, m, space)) {
            ++i_;
            scope(m[1].str().empty() ? "-" : spaces + m[1].str() + "::", false);
            return true;
        }
        if (std::regex_search(before, m, type)) {
            if (!in_type && spaces != "-") types.push_back(spaces + m[1].str());
            ++i_;
            scope(spaces, true);
            return true;
        }
        const std::size_t list = list_of(before);
        if (list == std::string::npos || is_value(before, list)) {
            skip();
            return false;
        }
        const std::size_t first = start;
        skip();
        head(first, i_);
        return true;
    }

    /// Whether a brace after `before` opens a member's or a variable's value.
    static bool is_value(const std::string& before, std::size_t list) {
        static const std::regex members(R"(\)[^()]*[^:]:[^:].*[\w>]\s*$)");
        const std::string rest = before.substr(list);
        static const std::regex assigned(R"([^=!<>]=\s*[\w:<>]*\s*$)");
        std::string flat = rest;
        std::replace(flat.begin(), flat.end(), '\n', ' ');
        return std::regex_search(flat, members) || std::regex_search(flat, assigned);
    }

    /// Where the parameters in what stands before a body or a semicolon open.
    static std::size_t list_of(const std::string& before) {
        static const std::set<std::string> not_functions{"decltype",      "noexcept", "alignas", "requires",
                                                         "static_assert", "if",       "for"};
        int angles = 0;
        for (std::size_t i = 0; i < before.size(); ++i) {
            if (before[i] == '=' && before.substr(0, i).find("operator") == std::string::npos && angles == 0)
                return std::string::npos;
            if (before[i] == '<') ++angles;
            if (before[i] == '>' && i > 0 && before[i - 1] != '-') --angles;
            if (before[i] != '(') continue;
            std::size_t end = i;
            while (end > 0 && std::isspace(static_cast<unsigned char>(before[end - 1])) != 0) --end;
            std::size_t begin = end;
            while (begin > 0 && is_name(before[begin - 1])) --begin;
            const std::string name = before.substr(begin, end - begin);
            if (name == "operator") return before.find('(', i + 1);
            if ((!name.empty() && !not_functions.contains(name)) || before.find("operator") < i) return i;
        }
        return std::string::npos;
    }

    /// Notes the function whose head begins at `start`; its body ends at `end`, 0: there is none.
    void head(std::size_t start, std::size_t end) {
        const std::string before = text_.substr(start, (end > 0 ? end : i_) - start);
        const std::size_t open = list_of(before);
        if (open == std::string::npos) return;
        const std::size_t first = std::min(before.find_first_not_of(" \n"), before.size());
        std::size_t name = open;
        while (name > 0 && (is_name(before[name - 1]) || before[name - 1] == ':' || before[name - 1] == '~')) --name;
        const auto lines =
            end > 0 ? std::count(before.begin() + static_cast<std::ptrdiff_t>(first), before.end(), '\n') + 1 : 0;
        functions.push_back(
            {before.substr(name, open - name), static_cast<std::size_t>(lines), parameters(before, open)});
    }

    /// From a brace to the one that closes it.
    void skip() {
        for (int depth = 0; i_ < text_.size(); ++i_) {
            if (text_[i_] == '{') ++depth;
            if (text_[i_] == '}' && --depth == 0) return;
        }
    }

    Plain plain_;
    const std::string& text_;
    std::size_t i_ = 0;
};

/// Names of the functions of src that are beyond a limit.
template <class IsWrong> Strings functions(IsWrong&& is_wrong) {
    std::set<std::string> wrong;
    std::size_t all = 0;
    for (const Source& source : all_sources())
        for (const Function& f : Outline(source).functions) {
            ++all;
            if (is_wrong(f)) wrong.insert(f.name);
        }
    EXPECT_GT(all, 2000u) << "functions are not found";
    return {wrong.begin(), wrong.end()};
}

/// Present offenders. A list that only gets shorter: whoever mends one takes it out.
const Strings kLongLists{"PassGather",       "PassGather::PassGather", "draw_chains",   "grow",
                         "perturb_from_eye", "retrace_specular_chain", "sample_direct", "start_pass"};

} // namespace

TEST(CodeShape, FunctionsFitAScreen) {
    EXPECT_THAT(functions([](const Function& f) { return f.lines > kMostLines; }), testing::IsEmpty());
}

TEST(CodeShape, ParameterListsAreShort) {
    EXPECT_THAT(functions([](const Function& f) { return f.parameters > kMostParameters; }),
                testing::ElementsAreArray(kLongLists));
}

TEST(CodeShape, FoldersAreSmall) {
    std::map<std::string, std::size_t> entries;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(keyhole::source_test::root()))
        ++entries[entry.path().parent_path().generic_string()];
    for (const auto& [folder, count] : entries) EXPECT_LE(count, kMostEntries) << folder;
}

TEST(CodeShape, NoNameOfATypeIsDefinedTwice) {
    std::map<std::string, Strings> places;
    for (const Source& source : all_sources())
        for (const std::string& type : Outline(source).types) places[type].push_back(source.path);
    EXPECT_GT(places.size(), 200u) << "types are not found";
    for (const auto& [type, where] : places)
        EXPECT_EQ(where.size(), 1u) << type << ": " << testing::PrintToString(where);
}

TEST(CodeShape, OutlinesFindWhatIsThere) {
    const Source source{"a.h",
                        {"// struct Comment {",
                         "namespace keyhole {",
                         "struct Plain;",
                         "struct Plain {",
                         "    int i{0};",
                         "    Plain(int a, int b = f(1, 2)) : i{a}, j_(b) {}",
                         "    struct Inner {};",
                         "};",
                         "template <class A, class B> class Derived final : public Plain {};",
                         "enum class Word : int { a, b };",
                         "constexpr int kTable[] = {1, 2};",
                         "const std::map<int, int> kMap{{1, 2}};",
                         "int call(const std::map<int, std::pair<int, int>>& m, int n = 100'000,",
                         "         char c = '{');",
                         "namespace {",
                         "struct Hidden {};",
                         "double longer(int x) {",
                         "    if (x) { return \"}\"[0]; }",
                         "    return 0;",
                         "}",
                         "} // namespace",
                         "bool operator==(A a, B b) { return a.x == b.x; }",
                         "} // namespace keyhole"}};
    const Outline outline(source);
    EXPECT_THAT(outline.types, testing::ElementsAre("keyhole::Plain", "keyhole::Derived", "keyhole::Word"));
    Strings found;
    for (const Function& f : outline.functions)
        found.push_back(f.name + " " + std::to_string(f.lines) + " " + std::to_string(f.parameters));
    EXPECT_THAT(found, testing::ElementsAre("Plain 1 2", "call 0 3", "longer 4 1", testing::_));
}
