#include "mpi/messages.h"

#include "core/error.h"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <exception>
#include <limits>
#include <memory>
#include <thread>
#include <utility>

namespace keyhole {
namespace {

enum Tag : int { kSize, kBytes };

constexpr std::size_t kMostBytes = std::size_t{1} << 30; // of a message

void nap() { std::this_thread::sleep_for(std::chrono::milliseconds(1)); }

/// Memory that a message which is under way reads or writes. If waiting for it is given up, MPI may still do so: it is
/// never freed then.
template <class T> class Lent {
  public:
    explicit Lent(T value) : value_(std::make_unique<T>(std::move(value))) {}
    Lent(const Lent&) = delete;
    Lent& operator=(const Lent&) = delete;
    ~Lent() {
        if (std::uncaught_exceptions() > exceptions_) static_cast<void>(value_.release());
    }
    T& operator*() { return *value_; }
    T* operator->() { return value_.get(); }

  private:
    std::unique_ptr<T> value_;
    int exceptions_ = std::uncaught_exceptions();
};

} // namespace

void send_signal(MPI_Comm comm, int to, int tag) {
    MPI_Request request = MPI_REQUEST_NULL;
    MPI_Isend(nullptr, 0, MPI_BYTE, to, tag, comm, &request);
    MPI_Request_free(&request); // there are no bytes to be kept until it is done
}

std::optional<MPI_Status> look_for(MPI_Comm comm, int source, int tag) {
    MPI_Status status;
    int there = 0;
    MPI_Iprobe(source, tag, comm, &there, &status);
    return there != 0 ? std::optional(status) : std::nullopt;
}

MPI_Status wait_for(MPI_Comm comm, int source, int tag, const Check& check) {
    for (;; nap()) {
        if (const auto status = look_for(comm, source, tag)) return *status;
        check();
    }
}

void take_signal(MPI_Comm comm, int source, int tag) {
    MPI_Recv(nullptr, 0, MPI_BYTE, source, tag, comm, MPI_STATUS_IGNORE);
}

void wait_for(MPI_Request& request, const Check& check) {
    for (int done = 0;; nap()) {
        MPI_Test(&request, &done, MPI_STATUS_IGNORE);
        if (done != 0) return;
        check();
    }
}

void send_bytes(MPI_Comm comm, int to, std::vector<char> bytes, const Check& check) {
    Lent<std::uint64_t> size(bytes.size());
    Lent<std::vector<char>> lent(std::move(bytes));
    MPI_Request request = MPI_REQUEST_NULL;
    MPI_Isend(&*size, 1, MPI_UINT64_T, to, kSize, comm, &request);
    wait_for(request, check);
    for (std::size_t at = 0; at < lent->size(); at += kMostBytes) {
        const auto part = static_cast<int>(std::min(kMostBytes, lent->size() - at));
        MPI_Isend(lent->data() + at, part, MPI_BYTE, to, kBytes, comm, &request);
        wait_for(request, check);
    }
}

Exchanged exchange_bytes(MPI_Comm comm, std::vector<char> part, bool stop, const Check& check) {
    int size = 0;
    MPI_Comm_size(comm, &size);
    struct Head {
        std::uint64_t bytes, stop;
    };
    struct Buffers {
        Head own;
        std::vector<Head> heads;
        std::vector<int> counts, begins;
        std::vector<char> part, all;
    };
    Lent<Buffers> b({Head{part.size(), stop ? std::uint64_t{1} : std::uint64_t{0}},
                     std::vector<Head>(static_cast<std::size_t>(size)),
                     {},
                     {},
                     std::move(part),
                     {}});
    MPI_Request request = MPI_REQUEST_NULL;
    MPI_Iallgather(&b->own, 2, MPI_UINT64_T, b->heads.data(), 2, MPI_UINT64_T, comm, &request);
    wait_for(request, check);

    std::uint64_t total = 0;
    Exchanged all{{}, false};
    for (const Head& h : b->heads) {
        b->counts.push_back(static_cast<int>(h.bytes));
        b->begins.push_back(static_cast<int>(total));
        total += h.bytes;
        all.stop = all.stop || h.stop != 0;
    }
    if (total > std::numeric_limits<int>::max())
        throw InputError("found a pass that sends 2 GiB at once, expected less: ask for more passes of fewer photons");
    b->all.resize(total);
    MPI_Iallgatherv(b->part.data(), static_cast<int>(b->part.size()), MPI_BYTE, b->all.data(), b->counts.data(),
                    b->begins.data(), MPI_BYTE, comm, &request);
    wait_for(request, check);
    for (std::size_t r = 0; r < b->heads.size(); ++r) {
        const auto* begin = b->all.data() + b->begins[r];
        all.parts.emplace_back(begin, begin + b->counts[r]);
    }
    return all;
}

std::vector<char> receive_bytes(MPI_Comm comm, int from, const Check& check) {
    wait_for(comm, from, kSize, check);
    std::uint64_t size = 0;
    MPI_Recv(&size, 1, MPI_UINT64_T, from, kSize, comm, MPI_STATUS_IGNORE);
    Lent<std::vector<char>> bytes{std::vector<char>(size)};
    for (std::size_t at = 0; at < bytes->size(); at += kMostBytes) {
        const auto part = static_cast<int>(std::min(kMostBytes, bytes->size() - at));
        MPI_Request request = MPI_REQUEST_NULL;
        MPI_Irecv(bytes->data() + at, part, MPI_BYTE, from, kBytes, comm, &request);
        wait_for(request, check);
    }
    return std::move(*bytes);
}

} // namespace keyhole
