#include "core/bytes.h"

#include <bit>
#include <gtest/gtest.h>

namespace keyhole {
namespace {

struct Sums {
    int words = 0;
    std::vector<std::uint32_t> data;
    auto parts() { return std::tie(words, data); }
    bool operator==(const Sums&) const = default;
};

struct All {
    double number = 0;
    std::string text;
    std::map<std::string, Sums> sums;
    std::optional<std::vector<std::string>> there, missing;
    auto parts() { return std::tie(number, text, sums, there, missing); }
    bool operator==(const All&) const = default;
};

const All kAll{0.5, "a\0b\n", {{"", {1, {}}}, {"film", {2, {7, 8}}}}, std::vector<std::string>{"x", ""}, std::nullopt};

std::vector<char> written() {
    ByteWriter writer;
    writer.put(kAll);
    return writer.take();
}

TEST(Bytes, ComeBackAsTheValuesThatWereWritten) {
    const auto bytes = written();
    ByteReader reader(bytes);
    EXPECT_EQ(reader.get<All>(), kAll);
    EXPECT_TRUE(reader.at_end());
}

TEST(Bytes, ThatEndTooEarlyAreRefusedAtEachLength) {
    const auto bytes = written();
    for (std::size_t n = 0; n < bytes.size(); ++n) {
        ByteReader reader(std::span<const char>(bytes).first(n));
        EXPECT_THROW(reader.get<All>(), InputError) << n;
    }
}

TEST(Bytes, ThatPromiseMoreThanMemoryHoldsAreRefused) {
    ByteWriter writer;
    writer.put(std::uint64_t{1} << 62); // times 4 this wraps around
    const auto bytes = writer.take();
    EXPECT_THROW(ByteReader(bytes).get<std::vector<std::uint32_t>>(), InputError);
    EXPECT_THROW(ByteReader(bytes).get<std::string>(), InputError);
    EXPECT_THROW(ByteReader(bytes).get<std::vector<Sums>>(), InputError);
}

TEST(Bytes, AreNumbersAsInMemory) {
    ByteWriter writer;
    writer.put(std::int32_t{258});
    const std::vector<char> expected =
        std::endian::native == std::endian::little ? std::vector<char>{2, 1, 0, 0} : std::vector<char>{0, 0, 1, 2};
    EXPECT_EQ(writer.take(), expected);
}

} // namespace
} // namespace keyhole
