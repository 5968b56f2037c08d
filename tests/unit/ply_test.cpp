// The PLY reader: every layout gives the same mesh, and nothing broken passes or hangs.
#include "core/error.h"
#include "scene/load/input.h"
#include "scene/load/load_mesh.h"
#include "support/scratch_directory.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <cstring>

namespace keyhole {
namespace {

template <class T> void put(std::string& bytes, T value, bool big) {
    std::array<char, sizeof(T)> raw;
    std::memcpy(raw.data(), &value, sizeof(T));
    if (big) std::reverse(raw.begin(), raw.end());
    bytes.append(raw.data(), raw.size());
}

/// A quad and a triangle with normals, texture coordinates, and properties that nobody asked for.
std::string header(const std::string& format) {
    return "ply\r\nformat " + format +
           " 1.0\ncomment made by hand\nelement stray 1\nproperty list uchar short junk\nelement vertex 5\n"
           "property double x\nproperty float y\nproperty float z\nproperty float nx\nproperty float ny\n"
           "property float nz\nproperty uchar red\nproperty float s\nproperty float t\nelement face 2\n"
           "property list uchar int vertex_indices\nproperty float quality\nend_header\n";
}

constexpr std::array<std::array<float, 8>, 5> kVertices{{{0, 0, 0, 0, 0, 1, 0, 0},
                                                         {2, 0, 0, 0, 0, 2, 1, 0},
                                                         {2, 1, 0, 0, 0, 0, 1, 1},
                                                         {0, 1, 0, 0, 0, 1, 0, 1},
                                                         {0, 2, 0.5f, 0, 0, 1, 0, 2}}};

std::string binary_body(bool big) {
    std::string b;
    put<std::uint8_t>(b, 2, big), put<std::int16_t>(b, 7, big), put<std::int16_t>(b, -7, big);
    for (const auto& v : kVertices) {
        put<double>(b, v[0], big);
        for (std::size_t i = 1; i < 6; ++i) put<float>(b, v[i], big);
        put<std::uint8_t>(b, 255, big);
        put<float>(b, v[6], big), put<float>(b, v[7], big);
    }
    put<std::uint8_t>(b, 4, big);
    for (const int i : {0, 1, 2, 3}) put<std::int32_t>(b, i, big);
    put<float>(b, 1, big);
    put<std::uint8_t>(b, 3, big);
    for (const int i : {3, 2, 4}) put<std::int32_t>(b, i, big);
    put<float>(b, 1, big);
    return b;
}

std::string text_body() {
    std::string b = "2 7 -7\n";
    for (const auto& v : kVertices) {
        for (std::size_t i = 0; i < 6; ++i) b += std::to_string(v[i]) + " ";
        b += "255 +" + std::to_string(v[6]) + "\t" + std::to_string(v[7]) + "\r\n";
    }
    return b + "4 0 1 2 3 1\n3 3 2 4 1e0\n";
}

void expect_the_mesh(const TriangleMesh& mesh) {
    ASSERT_EQ(mesh.positions.size(), 5u);
    EXPECT_EQ(mesh.positions[4], Vec3(0, 2, 0.5f));
    EXPECT_EQ(mesh.normals[1], Vec3(0, 0, 1)) << "normals are made unit";
    EXPECT_EQ(mesh.normals[2], Vec3(0, 0, 1)) << "a zero normal is replaced";
    EXPECT_EQ(mesh.uvs[4], Vec2(0, 2));
    using T = std::array<std::uint32_t, 3>;
    EXPECT_THAT(mesh.triangles, testing::ElementsAre(T{0, 1, 2}, T{0, 2, 3}, T{3, 2, 4}));
}

TEST(Ply, AllLayoutsGiveTheSameMesh) {
    const ScratchDirectory d;
    expect_the_mesh(read_ply(d.write("t.ply", header("ascii") + text_body())));
    expect_the_mesh(read_ply(d.write("l.ply", header("binary_little_endian") + binary_body(false))));
    expect_the_mesh(read_ply(d.write("b.ply", header("binary_big_endian") + binary_body(true))));
}

/// Packed with gzip.
std::string packed(const std::string& bytes) {
    z_stream stream{};
    EXPECT_EQ(deflateInit2(&stream, 9, Z_DEFLATED, 16 + MAX_WBITS, 8, Z_DEFAULT_STRATEGY), Z_OK);
    std::string out(deflateBound(&stream, bytes.size()), '\0');
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
    stream.avail_in = static_cast<uInt>(bytes.size());
    stream.next_out = reinterpret_cast<Bytef*>(out.data());
    stream.avail_out = static_cast<uInt>(out.size());
    EXPECT_EQ(deflate(&stream, Z_FINISH), Z_STREAM_END);
    out.resize(stream.total_out);
    deflateEnd(&stream);
    return out;
}

TEST(Ply, MeshesPackedWithGzipAreTheSame) {
    const ScratchDirectory d;
    const std::string binary = header("binary_little_endian") + binary_body(false);
    expect_the_mesh(read_ply(d.write("l.ply.gz", packed(binary))));
    expect_the_mesh(import_mesh(d.write("T.PLY.GZ", packed(header("ascii") + text_body()))));
    const std::string parts = packed(binary.substr(0, 100)) + packed(binary.substr(100)) + "and a tail";
    expect_the_mesh(read_ply(d.write("parts.ply.gz", parts)));
    EXPECT_THROW(import_mesh(d.write("t.obj.gz", packed("v 0 0 0\n"))), InputError);
}

TEST(Ply, BrokenPackedMeshesAreNamed) {
    const ScratchDirectory d;
    const std::string whole = packed(header("ascii") + text_body());
    const auto error = [&](const std::string& bytes) {
        const std::string path = d.write("t.ply.gz", bytes);
        try {
            read_ply(path);
        } catch (const InputError& e) {
            EXPECT_EQ(std::string(e.what()).rfind(path + ": found", 0), 0u) << e.what();
            return std::string(e.what());
        }
        return std::string();
    };
    for (std::size_t n = 2; n < whole.size(); n += 5)
        EXPECT_THAT(error(whole.substr(0, n)), testing::HasSubstr("early"));
    std::string wrong = whole;
    wrong[whole.size() - 6] ^= 1; // of the checksum
    EXPECT_THAT(error(wrong), testing::HasSubstr("found broken packed data (incorrect data check)"));
    EXPECT_THAT(error("\x1f\x8bjunk and more junk"), testing::HasSubstr("found broken packed data"));
    const std::string many = d.write("many.gz", packed(std::string(5000, 'a')));
    EXPECT_THROW(read_packed_file(many, 4999), InputError);
    EXPECT_EQ(read_packed_file(many, 5000), std::string(5000, 'a'));
}

TEST(Ply, EveryTruncationIsAnError) {
    const ScratchDirectory d;
    for (const std::string& whole :
         {header("ascii") + text_body(), header("binary_little_endian") + binary_body(false)}) {
        for (std::size_t n = 0; n + 4 < whole.size(); n += 7) // text may lose its last digits unseen
            EXPECT_THROW(read_ply(d.write("cut.ply", whole.substr(0, n))), InputError) << n;
    }
}

TEST(Ply, ImpossibleCountsAreErrors) {
    const ScratchDirectory d;
    const std::string xyz = "property float x\nproperty float y\nproperty float z\n";
    const std::string ascii = "ply\nformat ascii 1.0\n";
    for (const std::string& text :
         {(ascii + "element vertex 4000000000\n").append(xyz).append("end_header\n"),
          (ascii + "element vertex -1\n").append(xyz),
          ascii + "element face 1\nproperty list uchar int vertex_indices\nend_header\n4000000000 1 2",
          ascii + "element face 1\nproperty list char int vertex_indices\nend_header\n-3 1 2 3",
          ascii + "element face 9\nend_header\n0 0 0 0 0 0 0", "ply\nformat ascii 1.0\nproperty float x\n" + xyz,
          std::string("ply\nformat zip 1.0\nend_header\n"), std::string("ply\nend_header\n"), std::string("solid")})
        EXPECT_THROW(read_ply(d.write("bad.ply", text)), InputError) << text;
}

TEST(Ply, NumbersBeyondADoubleAreErrorsAndThoseBelowAreNothing) {
    const ScratchDirectory d;
    const auto mesh = [&](const std::string& x) {
        return read_ply(d.write("t.ply", "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                                         "property float z\nelement face 1\nproperty list uchar int vertex_indices\n"
                                         "end_header\n" +
                                             x + " -1 0\n0 0 0\n1 0 0\n3 0 1 2\n"));
    };
    EXPECT_EQ(mesh("1e-400").positions[0], Vec3(0, -1, 0));
    EXPECT_THROW(mesh("1e400"), InputError);
    EXPECT_THROW(mesh("-1e400"), InputError);
}

} // namespace
} // namespace keyhole
