#include "mpi/messages.h"

#include "core/error.h"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <limits>
#include <thread>

namespace keyhole {
namespace {

enum Tag : int { kSize, kBytes };

constexpr std::size_t kMostBytes = std::size_t{1} << 30; // of a message

void nap() { std::this_thread::sleep_for(std::chrono::milliseconds(1)); }

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

void send_bytes(MPI_Comm comm, int to, const std::vector<char>& bytes, const Check& check) {
    const std::uint64_t size = bytes.size();
    MPI_Request request = MPI_REQUEST_NULL;
    MPI_Isend(&size, 1, MPI_UINT64_T, to, kSize, comm, &request);
    wait_for(request, check);
    for (std::size_t at = 0; at < bytes.size(); at += kMostBytes) {
        const auto part = static_cast<int>(std::min(kMostBytes, bytes.size() - at));
        MPI_Isend(bytes.data() + at, part, MPI_BYTE, to, kBytes, comm, &request);
        wait_for(request, check);
    }
}

Exchanged exchange_bytes(MPI_Comm comm, const std::vector<char>& part, bool stop, const Check& check) {
    int size = 0;
    MPI_Comm_size(comm, &size);
    struct Head {
        std::uint64_t bytes, stop;
    };
    const Head own{part.size(), stop ? std::uint64_t{1} : std::uint64_t{0}};
    std::vector<Head> heads(static_cast<std::size_t>(size));
    MPI_Request request = MPI_REQUEST_NULL;
    MPI_Iallgather(&own, 2, MPI_UINT64_T, heads.data(), 2, MPI_UINT64_T, comm, &request);
    wait_for(request, check);

    std::vector<int> counts, begins;
    std::uint64_t total = 0;
    Exchanged all{{}, false};
    for (const Head& h : heads) {
        counts.push_back(static_cast<int>(h.bytes));
        begins.push_back(static_cast<int>(total));
        total += h.bytes;
        all.stop = all.stop || h.stop != 0;
    }
    if (total > std::numeric_limits<int>::max())
        throw InputError("found a pass that sends 2 GiB at once, expected less: ask for more passes of fewer photons");
    std::vector<char> bytes(total);
    MPI_Iallgatherv(part.data(), static_cast<int>(part.size()), MPI_BYTE, bytes.data(), counts.data(), begins.data(),
                    MPI_BYTE, comm, &request);
    wait_for(request, check);
    for (std::size_t r = 0; r < heads.size(); ++r) {
        const auto* begin = bytes.data() + begins[r];
        all.parts.emplace_back(begin, begin + counts[r]);
    }
    return all;
}

std::vector<char> receive_bytes(MPI_Comm comm, int from, const Check& check) {
    wait_for(comm, from, kSize, check);
    std::uint64_t size = 0;
    MPI_Recv(&size, 1, MPI_UINT64_T, from, kSize, comm, MPI_STATUS_IGNORE);
    std::vector<char> bytes(size);
    for (std::size_t at = 0; at < bytes.size(); at += kMostBytes) {
        const auto part = static_cast<int>(std::min(kMostBytes, bytes.size() - at));
        MPI_Request request = MPI_REQUEST_NULL;
        MPI_Irecv(bytes.data() + at, part, MPI_BYTE, from, kBytes, comm, &request);
        wait_for(request, check);
    }
    return bytes;
}

} // namespace keyhole
