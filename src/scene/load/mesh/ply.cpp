#include "scene/load/load_mesh.h"

#include "core/error.h"
#include "scene/load/input.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <map>
#include <optional>
#include <sstream>

namespace keyhole {
namespace {

enum class Type : std::uint8_t { int8, uint8, int16, uint16, int32, uint32, float32, float64 };
enum class Layout : std::uint8_t { text, little_endian, big_endian };

struct Property {
    std::string name;
    Type type;
    std::optional<Type> count; ///< of a list
};

struct Element {
    std::string name;
    std::uint64_t count = 0;
    std::vector<Property> properties;
};

struct Header {
    Layout layout = Layout::text;
    std::vector<Element> elements;
    std::size_t size = 0; ///< bytes
};

/// Thrown within this file; read_ply() adds the path.
[[noreturn]] void fail(const std::string& message) { throw InputError(message); }

std::size_t size_of(Type type) {
    constexpr std::array<std::size_t, 8> kSizes{1, 1, 2, 2, 4, 4, 4, 8};
    return kSizes[static_cast<std::size_t>(type)];
}

std::optional<Type> find_type(const std::string& name) {
    static const std::map<std::string, Type> kTypes{
        {"char", Type::int8},     {"int8", Type::int8},       {"uchar", Type::uint8},    {"uint8", Type::uint8},
        {"short", Type::int16},   {"int16", Type::int16},     {"ushort", Type::uint16},  {"uint16", Type::uint16},
        {"int", Type::int32},     {"int32", Type::int32},     {"uint", Type::uint32},    {"uint32", Type::uint32},
        {"float", Type::float32}, {"float32", Type::float32}, {"double", Type::float64}, {"float64", Type::float64}};
    const auto found = kTypes.find(name);
    return found == kTypes.end() ? std::nullopt : std::optional(found->second);
}

Property parse_property(std::istringstream& words, const std::string& line) {
    const auto type = [&](const std::string& word) {
        const auto t = find_type(word);
        if (!t) fail(fmt::format("found the header line '{}', expected a property with a known type", line));
        return *t;
    };
    Property property{};
    std::string word;
    words >> word;
    if (word == "list") {
        words >> word;
        property.count = type(word);
        words >> word;
    }
    property.type = type(word);
    if (!(words >> property.name)) fail(fmt::format("found the header line '{}', expected a property's name", line));
    return property;
}

Layout parse_format(std::istringstream& words) {
    std::string name;
    words >> name;
    if (name == "ascii") return Layout::text;
    if (name == "binary_little_endian") return Layout::little_endian;
    if (name == "binary_big_endian") return Layout::big_endian;
    fail(fmt::format("found the format '{}', expected ascii, binary_little_endian or binary_big_endian",
                     name.substr(0, 40)));
}

/// Whatever the header promises, no element without a byte in the file is counted.
Element parse_element(std::istringstream& words, const std::string& line, std::size_t file_size) {
    Element element;
    if (!(words >> element.name >> element.count) || element.count > file_size)
        fail(fmt::format("found '{}' in a file of {} bytes, expected a name and a count", line, file_size));
    return element;
}

Header parse_header(const std::string& bytes) {
    constexpr std::size_t kLongestHeader = 1 << 16;
    if (!bytes.starts_with("ply")) fail("found no 'ply' at the beginning, expected a PLY file");
    Header header;
    bool has_format = false;
    for (std::size_t begin = 0; begin < std::min(bytes.size(), kLongestHeader);) {
        const std::size_t end = bytes.find('\n', begin);
        if (end == std::string::npos) break;
        std::string line = bytes.substr(begin, std::min<std::size_t>(end - begin, 200));
        if (line.ends_with('\r')) line.pop_back();
        begin = end + 1;
        std::istringstream words(line);
        std::string keyword;
        words >> keyword;
        if (keyword == "format") {
            header.layout = parse_format(words);
            has_format = true;
        } else if (keyword == "element") {
            header.elements.push_back(parse_element(words, line, bytes.size()));
        } else if (keyword == "property") {
            if (header.elements.empty()) fail(fmt::format("found '{}' before any element, expected one", line));
            header.elements.back().properties.push_back(parse_property(words, line));
        } else if (keyword == "end_header") {
            if (!has_format) fail("found a header without 'format', expected that line");
            header.size = begin;
            return header;
        }
    }
    fail("found a broken mesh (its header doesn't end), expected a valid one");
}

/// Numbers of a binary body.
class BinaryBody {
  public:
    BinaryBody(const std::string& bytes, std::size_t begin, Layout layout)
        : at_(bytes.data() + begin), end_(bytes.data() + bytes.size()),
          swap_((layout == Layout::little_endian) != (std::endian::native == std::endian::little)) {}

    double number(Type type) {
        switch (type) {
        case Type::int8:
            return get<std::int8_t>();
        case Type::uint8:
            return get<std::uint8_t>();
        case Type::int16:
            return get<std::int16_t>();
        case Type::uint16:
            return get<std::uint16_t>();
        case Type::int32:
            return get<std::int32_t>();
        case Type::uint32:
            return get<std::uint32_t>();
        case Type::float32:
            return static_cast<double>(get<float>());
        case Type::float64:
            return get<double>();
        }
        return 0;
    }

    /// Least number of bytes that a number of this type takes.
    static std::size_t least_size(Type type) { return size_of(type); }
    std::size_t left() const { return static_cast<std::size_t>(end_ - at_); }

  private:
    template <class T> T get() {
        if (left() < sizeof(T)) fail("found the end of the file within its data, expected the rest");
        std::array<char, sizeof(T)> raw;
        std::memcpy(raw.data(), at_, sizeof(T));
        at_ += sizeof(T);
        if (swap_) std::reverse(raw.begin(), raw.end());
        return std::bit_cast<T>(raw);
    }

    const char *at_, *end_;
    bool swap_;
};

/// Numbers of a text body, between white space.
class TextBody {
  public:
    TextBody(const std::string& bytes, std::size_t begin)
        : at_(bytes.data() + begin), end_(bytes.data() + bytes.size()) {}

    double number(Type /*type*/) {
        while (at_ != end_ && (*at_ == ' ' || *at_ == '\n' || *at_ == '\r' || *at_ == '\t')) ++at_;
        if (at_ == end_) fail("found the end of the file within its data, expected the rest");
        if (*at_ == '+') ++at_; // from_chars() knows no plus sign
        double value = 0;
        const auto [next, error] = std::from_chars(at_, end_, value);
        if (error == std::errc::invalid_argument)
            fail(fmt::format("found '{:.12}' in the data, expected a number",
                             std::string_view(at_, static_cast<std::size_t>(std::find(at_, end_, '\n') - at_))));
        // from_chars() doesn't tell too large from too small.
        if (error == std::errc::result_out_of_range) value = std::strtod(std::string(at_, next).c_str(), nullptr);
        at_ = next;
        return value;
    }

    static std::size_t least_size(Type /*type*/) { return 1; }
    std::size_t left() const { return static_cast<std::size_t>(end_ - at_); }

  private:
    const char *at_, *end_;
};

/// Reads the elements of one file into a mesh.
template <class Body> class MeshBuilder {
  public:
    explicit MeshBuilder(Body body) : body_(body) {}

    TriangleMesh build(const Header& header) {
        for (const Element& element : header.elements) {
            check_room(element);
            if (element.name == "vertex") {
                read_vertices(element);
            } else if (element.name == "face") {
                read_faces(element);
            } else {
                for (std::uint64_t i = 0; i < element.count; ++i)
                    for (const Property& p : element.properties) skip(p);
            }
        }
        return std::move(mesh_);
    }

  private:
    static constexpr int kSlots = 8; // x y z, nx ny nz, u v

    static int slot(const std::string& name) {
        static const std::map<std::string, int> kSlotOf{
            {"x", 0}, {"y", 1},         {"z", 2},         {"nx", 3}, {"ny", 4}, {"nz", 5},        {"u", 6},
            {"s", 6}, {"texture_u", 6}, {"texture_s", 6}, {"v", 7},  {"t", 7},  {"texture_v", 7}, {"texture_t", 7}};
        const auto found = kSlotOf.find(name);
        return found == kSlotOf.end() ? -1 : found->second;
    }

    /// Truncated files are refused before memory is taken for what they lack.
    void check_room(const Element& element) const {
        std::size_t least = 0;
        for (const Property& p : element.properties) least += Body::least_size(p.count ? *p.count : p.type);
        if (element.count * least > body_.left())
            fail(fmt::format("found {} bytes left for {} of '{}', expected {} at least", body_.left(), element.count,
                             element.name, element.count * least));
        if (least == 0 && element.count > 0)
            fail(fmt::format("found the element '{}' without properties, expected some", element.name));
    }

    std::uint64_t list_length(const Property& p) {
        const double n = body_.number(*p.count);
        if (!(n >= 0) || n * static_cast<double>(Body::least_size(p.type)) > static_cast<double>(body_.left()))
            fail(fmt::format("found a list of {} numbers, expected a length that fits into the file", n));
        return static_cast<std::uint64_t>(n);
    }

    void skip(const Property& p) {
        const std::uint64_t n = p.count ? list_length(p) : 1;
        for (std::uint64_t i = 0; i < n; ++i) body_.number(p.type);
    }

    void read_vertices(const Element& element) {
        std::vector<int> slots;
        unsigned present = 0;
        for (const Property& p : element.properties) {
            slots.push_back(p.count ? -1 : slot(p.name));
            if (slots.back() >= 0) present |= 1u << slots.back();
        }
        if ((present & 7u) != 7u) fail("found vertices without x, y and z, expected positions");
        const bool has_normals = (present & 0x38u) == 0x38u, has_uvs = (present & 0xC0u) == 0xC0u;
        mesh_.positions.reserve(element.count);
        if (has_normals) mesh_.normals.reserve(element.count);
        if (has_uvs) mesh_.uvs.reserve(element.count);
        std::array<float, kSlots> v{};
        for (std::uint64_t i = 0; i < element.count; ++i) {
            for (std::size_t k = 0; k < slots.size(); ++k) {
                const Property& p = element.properties[k];
                if (slots[k] < 0)
                    skip(p);
                else
                    v[static_cast<std::size_t>(slots[k])] = static_cast<float>(body_.number(p.type));
            }
            mesh_.positions.emplace_back(v[0], v[1], v[2]);
            if (has_normals) mesh_.normals.emplace_back(v[3], v[4], v[5]);
            if (has_uvs) mesh_.uvs.emplace_back(v[6], v[7]);
        }
    }

    void read_faces(const Element& element) {
        mesh_.triangles.reserve(element.count);
        for (std::uint64_t i = 0; i < element.count; ++i) {
            for (const Property& p : element.properties) {
                if (p.count && (p.name == "vertex_indices" || p.name == "vertex_index"))
                    read_face(p);
                else
                    skip(p);
            }
            if (mesh_.triangles.size() > kMaxMeshTriangles)
                fail(fmt::format("found more than {} triangles, expected fewer", kMaxMeshTriangles));
        }
    }

    void read_face(const Property& p) {
        const std::uint64_t n = list_length(p);
        if (n < 3) fail(fmt::format("found a face with {} corners, expected three at least", n));
        const std::uint32_t first = index(p), second = index(p);
        std::uint32_t last = second;
        for (std::uint64_t i = 2; i < n; ++i) {
            const std::uint32_t next = index(p);
            mesh_.triangles.push_back({first, last, next});
            last = next;
        }
    }

    std::uint32_t index(const Property& p) {
        const double i = body_.number(p.type);
        if (!(i >= 0 && i < 4294967295.0)) fail(fmt::format("found the vertex index {}, expected one of a vertex", i));
        return static_cast<std::uint32_t>(i);
    }

    Body body_;
    TriangleMesh mesh_;
};

TriangleMesh parse(const std::string& bytes) {
    const Header header = parse_header(bytes);
    if (header.layout == Layout::text) return MeshBuilder(TextBody(bytes, header.size)).build(header);
    return MeshBuilder(BinaryBody(bytes, header.size, header.layout)).build(header);
}

} // namespace

TriangleMesh read_ply(const std::string& path) {
    TriangleMesh mesh;
    try {
        constexpr std::size_t kMostUnpacked = std::size_t{1} << 32;
        mesh = parse(read_packed_file(path, kMostUnpacked));
    } catch (const InputError& e) {
        throw InputError({path, 0, 0}, e.what());
    }
    if (mesh.triangles.empty()) throw InputError({path, 0, 0}, "found no triangles, expected at least one");
    mend_mesh(mesh, path);
    return mesh;
}

} // namespace keyhole
