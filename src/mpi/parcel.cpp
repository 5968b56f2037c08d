#include "mpi/parcel.h"

#include <cstring>
#include <type_traits>

namespace keyhole {
namespace {

class Packer {
  public:
    template <class T> void number(const T& value) {
        static_assert(std::is_arithmetic_v<T>);
        raw(&value, sizeof value);
    }
    void text(const std::string& s) {
        number(s.size());
        raw(s.data(), s.size());
    }
    void raw(const void* data, std::size_t size) {
        const auto* begin = static_cast<const char*>(data);
        bytes.insert(bytes.end(), begin, begin + size);
    }
    std::vector<char> bytes;
};

class Unpacker {
  public:
    explicit Unpacker(const std::vector<char>& bytes) : at_(bytes.data()) {}
    template <class T> T number() {
        T value{};
        raw(&value, sizeof value);
        return value;
    }
    std::string text() {
        std::string s(number<std::size_t>(), '\0');
        raw(s.data(), s.size());
        return s;
    }
    void raw(void* data, std::size_t size) {
        if (size > 0) std::memcpy(data, at_, size);
        at_ += size;
    }

  private:
    const char* at_;
};

} // namespace

std::vector<char> pack(const Picture& part) {
    Packer to;
    to.number(part.width);
    to.number(part.height);
    to.number(part.metadata.size());
    for (const auto& [key, value] : part.metadata) {
        to.text(key);
        to.text(value);
    }
    to.number(part.sums.size());
    for (const auto& [kind, sums] : part.sums) {
        to.text(kind);
        to.number(sums.words);
        to.number(sums.data.size());
        to.raw(sums.data.data(), sums.data.size() * sizeof(std::uint32_t));
    }
    return std::move(to.bytes);
}

Picture unpack(const std::vector<char>& bytes) {
    Unpacker from(bytes);
    Picture part;
    part.width = from.number<int>();
    part.height = from.number<int>();
    for (auto n = from.number<std::size_t>(); n > 0; --n) {
        const std::string key = from.text();
        part.metadata[key] = from.text();
    }
    for (auto n = from.number<std::size_t>(); n > 0; --n) {
        PixelWords& sums = part.sums[from.text()];
        sums.words = from.number<int>();
        sums.data.resize(from.number<std::size_t>());
        from.raw(sums.data.data(), sums.data.size() * sizeof(std::uint32_t));
    }
    return part;
}

} // namespace keyhole
