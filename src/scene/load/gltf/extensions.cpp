#include "scene/load/gltf/extensions.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace keyhole::gltf {
namespace {

/// Compressed views are looked at one by one; Assimp knows about Draco.
constexpr std::array<std::string_view, 9> kReadExtensions{
    "KHR_lights_punctual",     "KHR_texture_transform",   "KHR_mesh_quantization",
    "EXT_mesh_gpu_instancing", "EXT_texture_webp",        "KHR_draco_mesh_compression",
    "EXT_meshopt_compression", "KHR_meshopt_compression", "KHR_texture_basisu"};
/// What they say makes no difference to a picture, or not to one that stands still.
constexpr std::array<std::string_view, 4> kWithoutLight{"KHR_xmp", "KHR_xmp_json_ld", "KHR_animation_pointer",
                                                        "MSFT_lod"};
constexpr std::array kCompressions{"EXT_meshopt_compression", "KHR_meshopt_compression"};

template <class List> bool is_among(const List& list, std::string_view name) {
    return std::ranges::find(list, name) != list.end();
}

/// Materials without their extensions are a likeness, and say which are left out.
bool is_known(std::string_view name) {
    return name.starts_with("KHR_materials_") || is_among(kReadExtensions, name) || is_among(kWithoutLight, name);
}

void check_compressed(const Document& document) {
    const Json& views = member(document.root(), "bufferViews");
    for (std::size_t i = 0; i < views.size(); ++i)
        for (const char* name : kCompressions) {
            if (!views[i].is_object() || extension(views[i], name) == nullptr) continue;
            const std::size_t buffer = document.buffer_of_view(i);
            const bool plain = document.entry("buffers", buffer).contains("uri") || (document.packed() && buffer == 0);
            if (!plain)
                document.fail(fmt::format("found {}, expected plain buffers: export it without compression", name));
        }
}

} // namespace

void check_extensions(const Document& document) {
    const auto required = value_or(document.root(), "extensionsRequired", std::vector<std::string>{});
    for (const std::string& name : required) {
        if (name == "KHR_texture_basisu")
            document.fail("found the extension KHR_texture_basisu, which the file requires, expected other pictures: "
                          "export it with PNG, JPEG or WebP");
        if (!is_known(name))
            document.fail(fmt::format("found the extension {}, which the file requires, expected one of those that are "
                                      "read: export it without",
                                      name));
    }
    for (const auto& name : value_or(document.root(), "extensionsUsed", std::vector<std::string>{}))
        if (!is_known(name)) document.warn(fmt::format("the extension {} is left out", name));
    check_compressed(document);
}

} // namespace keyhole::gltf
