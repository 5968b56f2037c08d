#include "scene/load/pbrt/syntax/include_stack.h"

#include "scene/load/input.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

namespace keyhole::pbrt {
namespace {

constexpr std::size_t kMostBytes = std::size_t{1} << 32;
constexpr std::size_t kMostDepth = 32;
constexpr std::size_t kMostFiles = 10'000; // files that include each other often, without a cycle, must end too

std::string canonical(const std::string& path) {
    std::error_code error;
    return std::filesystem::weakly_canonical(path, error).string();
}

} // namespace

IncludeStack::IncludeStack(const std::string& path)
    : path_(path), directory_(std::filesystem::path(path).parent_path().string()) {
    open(path);
}

void IncludeStack::open(const std::string& path) {
    std::string text = read_text_file(path, "a scene file", kMostBytes);
    if (text.starts_with("\x1f\x8b"))
        throw InputError({path, 0, 0}, "found a file packed with gzip, expected text (unpack it first)");
    files_.push_back({canonical(path), std::make_unique<DirectiveReader>(std::move(text), path)});
    ++opened_;
}

std::optional<Directive> IncludeStack::next() {
    while (!files_.empty()) {
        if (auto directive = files_.back().reader->next()) return directive;
        files_.pop_back();
    }
    return std::nullopt;
}

void IncludeStack::skip_to_directive() {
    if (!files_.empty()) files_.back().reader->skip_to_directive();
}

void IncludeStack::enter(const Directive& directive, const std::string& name) {
    const auto in = [&](const std::string& directory) {
        return (std::filesystem::path(directory) / name).lexically_normal().string();
    };
    std::string path = in(directory_);
    std::error_code error;
    if (!std::filesystem::exists(path, error)) {
        const std::string beside = in(std::filesystem::path(directive.position.file).parent_path().string());
        if (std::filesystem::exists(beside, error)) path = beside;
    }
    const std::string real = canonical(path);
    if (std::any_of(files_.begin(), files_.end(), [&](const File& f) { return f.canonical == real; }))
        directive.stop(fmt::format("found '{}' including itself, expected no cycle", path));
    if (files_.size() >= kMostDepth)
        directive.stop(fmt::format("found includes nested more than {} deep, expected fewer levels", kMostDepth));
    if (opened_ >= kMostFiles) directive.stop(fmt::format("found more than {} includes, expected fewer", kMostFiles));
    try {
        open(path);
    } catch (const InputError& e) {
        directive.stop(e.what());
    }
}

} // namespace keyhole::pbrt
