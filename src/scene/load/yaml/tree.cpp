#include "scene/load/yaml/tree.h"

#include <fmt/format.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/parser.h>

#include <algorithm>
#include <sstream>
#include <unordered_map>

namespace keyhole {
namespace {

/// Builds the tree from the parser's events. We don't take yaml-cpp's own tree, because it hides duplicate keys and
/// lets aliases make cycles.
class TreeBuilder final : public YAML::EventHandler {
  public:
    explicit TreeBuilder(const std::string& file) : file_(std::make_shared<const std::string>(file)) {}

    YamlPtr root() const { return root_; }

    void OnDocumentStart(const YAML::Mark& mark) override {
        if (root_) fail(mark, "found a second document, expected one");
    }
    void OnDocumentEnd() override {}
    void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
        add(make(mark, YamlNode::Kind::null), anchor);
    }
    void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override {
        const auto found = anchors_.find(anchor);
        if (found == anchors_.end()) fail(mark, "found an alias within its own anchor, expected a finished one");
        attach(found->second);
    }
    void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                  const std::string& value) override {
        auto node = make(mark, YamlNode::Kind::scalar);
        node->text = value;
        node->quoted = tag == "!"; // yaml-cpp's mark of a scalar in quotes
        add(std::move(node), anchor);
    }
    void OnSequenceStart(const YAML::Mark& mark, const std::string& /*tag*/, YAML::anchor_t anchor,
                         YAML::EmitterStyle::value /*style*/) override {
        open(mark, YamlNode::Kind::list, anchor);
    }
    void OnSequenceEnd() override { close(); }
    void OnMapStart(const YAML::Mark& mark, const std::string& /*tag*/, YAML::anchor_t anchor,
                    YAML::EmitterStyle::value /*style*/) override {
        open(mark, YamlNode::Kind::map, anchor);
    }
    void OnMapEnd() override { close(); }

  private:
    struct Open {
        std::shared_ptr<YamlNode> node;
        YAML::anchor_t anchor;
        YamlPtr key; ///< of a map: read, while its value is not
        std::unordered_map<std::string, YamlPtr> keys;
    };

    [[noreturn]] void fail(const YAML::Mark& mark, const std::string& message) const {
        throw InputError({*file_, mark.line + 1, mark.column + 1}, message);
    }

    std::shared_ptr<YamlNode> make(const YAML::Mark& mark, YamlNode::Kind kind) const {
        auto node = std::make_shared<YamlNode>();
        node->kind = kind;
        node->file = file_;
        node->line = mark.line + 1;
        node->column = mark.column + 1;
        return node;
    }

    void open(const YAML::Mark& mark, YamlNode::Kind kind, YAML::anchor_t anchor) {
        if (stack_.size() >= static_cast<std::size_t>(kMaxYamlHeight))
            fail_nesting({*file_, mark.line + 1, mark.column + 1});
        stack_.push_back({make(mark, kind), anchor, nullptr, {}});
    }

    void close() {
        Open done = std::move(stack_.back());
        stack_.pop_back();
        add(std::move(done.node), done.anchor);
    }

    void add(std::shared_ptr<YamlNode> node, YAML::anchor_t anchor) {
        if (node->kind == YamlNode::Kind::null && !stack_.empty() && stack_.back().key) {
            // The mark of a value left out is that of whatever follows it; people look for the key.
            node->line = stack_.back().key->line;
            node->column = stack_.back().key->column;
        }
        if (anchor != YAML::NullAnchor) anchors_[anchor] = node;
        attach(std::move(node));
    }

    void attach(YamlPtr node) {
        if (stack_.empty()) {
            root_ = std::move(node);
            return;
        }
        Open& parent = stack_.back();
        grow(*parent.node, *node);
        if (parent.node->kind == YamlNode::Kind::list) {
            parent.node->items.push_back(std::move(node));
        } else if (parent.key) {
            parent.node->entries.push_back({std::move(parent.key), std::move(node)});
            parent.key = nullptr;
        } else {
            parent.key = checked_key(parent, std::move(node));
        }
    }

    YamlPtr checked_key(Open& map, YamlPtr key) const {
        if (key->kind != YamlNode::Kind::scalar)
            throw InputError(key->position(), "found a key that is not a word, expected a word");
        const auto [first, fresh] = map.keys.emplace(key->text, key);
        if (!fresh)
            throw InputError(key->position(),
                             fmt::format("found the key '{}' again, expected it once (first on line {})", key->text,
                                         first->second->line));
        return key;
    }

    static void grow(YamlNode& parent, const YamlNode& child) {
        parent.size += child.size;
        parent.height = std::max(parent.height, child.height + 1);
        if (parent.size > kMaxYamlNodes)
            throw InputError(parent.position(), fmt::format("found more than {} values with aliases written out, "
                                                            "expected fewer",
                                                            kMaxYamlNodes));
        if (parent.height > kMaxYamlHeight) fail_nesting(parent.position());
    }

    [[noreturn]] static void fail_nesting(const FilePosition& where) {
        throw InputError(
            where, fmt::format("found lists and maps nested more than {} deep, expected fewer levels", kMaxYamlHeight));
    }

    std::shared_ptr<const std::string> file_;
    YamlPtr root_;
    std::vector<Open> stack_;
    std::unordered_map<YAML::anchor_t, YamlPtr> anchors_;
};

/// Scene files are text: control characters show that this is something else, and are better named than misread.
void reject_binary(const std::string& text, const std::string& file) {
    int line = 1, column = 1;
    for (const char c : text) {
        const auto byte = static_cast<unsigned char>(c);
        if ((byte < 0x20 && c != '\t' && c != '\n' && c != '\r') || byte == 0x7f)
            throw InputError({file, line, column}, fmt::format("found the byte 0x{:02x}, expected text", byte));
        ++column;
        if (c == '\n') ++line, column = 1;
    }
}

/// What a person may have done to a line that yaml-cpp stumbles at: its words don't tell.
std::string hint_at_line(const std::string& text, int line) {
    std::istringstream lines(text);
    std::string at;
    for (int i = 0; i <= line && std::getline(lines, at); ++i)
        if (at.find_first_not_of(" \t") > at.find('\t'))
            return fmt::format("spaces: line {} is indented by a tab", i + 1);
    return "valid YAML, indented as the lines around it";
}

} // namespace

YamlPtr parse_yaml(const std::string& text, const std::string& file, std::string_view what) {
    reject_binary(text, file);
    std::istringstream stream(text);
    TreeBuilder builder(file);
    try {
        YAML::Parser parser(stream);
        while (parser.HandleNextDocument(builder)) {
        }
    } catch (const YAML::Exception& e) {
        throw InputError({file, e.mark.line + 1, e.mark.column + 1},
                         fmt::format("found broken YAML ({}), expected {}", e.msg, hint_at_line(text, e.mark.line)));
    }
    if (!builder.root()) throw InputError({file, 1, 1}, fmt::format("found an empty file, expected {}", what));
    return builder.root();
}

} // namespace keyhole
