// Feeds the reader of user paths with junk (libFuzzer): it may throw InputError and nothing else. What it can read it
// can read again from what is written.
// build-fuzz/tests/user_path_fuzz CORPUS userpaths
#include "junk_file.h"
#include "scene/load/yaml/user_path_file.h"

#include <cstdlib>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    return keyhole::survive([&] {
        const keyhole::UserPathFile file = keyhole::load_user_paths(keyhole::junk_file(data, size, ".yaml"));
        const std::string text = keyhole::user_paths_text(file, "again");
        const auto* bytes = reinterpret_cast<const std::uint8_t*>(text.data());
        try {
            if (keyhole::load_user_paths(keyhole::junk_file(bytes, text.size(), ".yaml")).paths.size() !=
                file.paths.size())
                std::abort();
        } catch (const keyhole::InputError&) {
            std::abort();
        }
    });
}
