#include "scene/load/gzip.h"

#include "core/error.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <limits>

namespace keyhole {
namespace {

/// zlib's state for one part of a file.
class Inflater {
  public:
    explicit Inflater(std::string_view packed) : left_(packed), waiting_(packed.size()) {
        constexpr int kGzipOnly = 16 + MAX_WBITS;
        if (inflateInit2(&stream_, kGzipOnly) != Z_OK) throw std::bad_alloc();
    }
    ~Inflater() { inflateEnd(&stream_); }
    Inflater(const Inflater&) = delete;
    Inflater& operator=(const Inflater&) = delete;

    /// Appends what is packed in the part. @returns what follows it.
    std::string_view unpack(std::string& out, std::size_t most_bytes) {
        for (int state = Z_OK; state != Z_STREAM_END;) {
            feed();
            stream_.next_out = buffer_.data();
            stream_.avail_out = static_cast<uInt>(buffer_.size());
            state = inflate(&stream_, Z_NO_FLUSH);
            if (state == Z_MEM_ERROR) throw std::bad_alloc();
            if (state == Z_BUF_ERROR && stream_.avail_in == 0)
                throw InputError("found packed data that end too early, expected a whole gzip file");
            if (state != Z_OK && state != Z_STREAM_END)
                throw InputError(fmt::format("found broken packed data ({}), expected a valid gzip file",
                                             stream_.msg != nullptr ? stream_.msg : "no known reason"));
            out.append(reinterpret_cast<const char*>(buffer_.data()), buffer_.size() - stream_.avail_out);
            if (out.size() > most_bytes)
                throw InputError(fmt::format("found more than {} bytes packed with gzip, expected fewer", most_bytes));
        }
        left_.remove_prefix(left_.size() - waiting_ - stream_.avail_in);
        return left_;
    }

  private:
    /// zlib counts in 32 bits.
    void feed() {
        if (stream_.avail_in > 0) return;
        const std::size_t n = std::min<std::size_t>(waiting_, std::numeric_limits<uInt>::max());
        const char* at = left_.data() + (left_.size() - waiting_);
        stream_.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(at));
        stream_.avail_in = static_cast<uInt>(n);
        waiting_ -= n;
    }

    std::string_view left_;
    std::size_t waiting_; ///< bytes at the end that zlib hasn't been told of
    z_stream stream_{};
    std::array<Bytef, 1 << 16> buffer_;
};

} // namespace

std::string gunzip(std::string_view packed, std::size_t most_bytes) {
    std::string out;
    do packed = Inflater(packed).unpack(out, most_bytes);
    while (is_gzip(packed));
    return out;
}

} // namespace keyhole
