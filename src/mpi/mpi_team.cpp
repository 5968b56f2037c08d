#include "mpi/mpi_team.h"

#include "mpi/parcel.h"

#include <algorithm>
#include <chrono>
#include <mpi.h>

namespace keyhole {
namespace {

enum Tag : int { kAsk, kNumber, kNoMore, kGo, kSize, kBytes };

constexpr std::size_t kMostBytes = std::size_t{1} << 30; // of a message

/// Sleeps until a message is there.
MPI_Status wait_for(int source, int tag) {
    MPI_Status status;
    for (int there = 0;;) {
        MPI_Iprobe(source, tag, MPI_COMM_WORLD, &there, &status);
        if (there != 0) return status;
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
}

void send_signal(int to, int tag) { MPI_Send(nullptr, 0, MPI_BYTE, to, tag, MPI_COMM_WORLD); }

/// Waits for a signal. @returns who sent it.
int receive_signal(int source, int tag) {
    const MPI_Status status = wait_for(source, tag);
    MPI_Recv(nullptr, 0, MPI_BYTE, status.MPI_SOURCE, status.MPI_TAG, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    return status.MPI_SOURCE;
}

void send_bytes(const std::vector<char>& bytes, int to) {
    const std::uint64_t size = bytes.size();
    MPI_Send(&size, 1, MPI_UINT64_T, to, kSize, MPI_COMM_WORLD);
    for (std::size_t at = 0; at < size; at += kMostBytes)
        MPI_Send(bytes.data() + at, static_cast<int>(std::min(kMostBytes, bytes.size() - at)), MPI_BYTE, to, kBytes,
                 MPI_COMM_WORLD);
}

std::vector<char> receive_bytes(int from) {
    std::uint64_t size = 0;
    MPI_Recv(&size, 1, MPI_UINT64_T, from, kSize, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    std::vector<char> bytes(size);
    for (std::size_t at = 0; at < size; at += kMostBytes)
        MPI_Recv(bytes.data() + at, static_cast<int>(std::min(kMostBytes, bytes.size() - at)), MPI_BYTE, from, kBytes,
                 MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    return bytes;
}

} // namespace

MpiTeam::MpiTeam() {
    MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
    MPI_Comm_size(MPI_COMM_WORLD, &size_);
    if (rank_ == 0 && size_ > 1) counter_ = std::thread([this] { hand_out(); });
}

MpiTeam::~MpiTeam() { finish(); }

void MpiTeam::finish() {
    if (rank_ > 0 && !is_finished_) send_signal(0, kNoMore);
    is_finished_ = true;
    if (counter_.joinable()) counter_.join();
}

void MpiTeam::hand_out() {
    for (int working = size_ - 1; working > 0;) {
        const MPI_Status status = wait_for(MPI_ANY_SOURCE, MPI_ANY_TAG);
        receive_signal(status.MPI_SOURCE, status.MPI_TAG);
        if (status.MPI_TAG == kNoMore) {
            --working;
            continue;
        }
        const std::int64_t number = next_++;
        MPI_Send(&number, 1, MPI_INT64_T, status.MPI_SOURCE, kNumber, MPI_COMM_WORLD);
    }
}

std::int64_t MpiTeam::take_number() {
    if (rank_ == 0) return next_++;
    send_signal(0, kAsk);
    wait_for(0, kNumber);
    std::int64_t number = 0;
    MPI_Recv(&number, 1, MPI_INT64_T, 0, kNumber, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    return number;
}

void MpiTeam::wait_for_all() { MPI_Barrier(MPI_COMM_WORLD); }

void MpiTeam::collect(const Picture& part, const std::function<void(Picture)>& join) {
    finish();
    if (rank_ > 0) {
        receive_signal(0, kGo);
        send_bytes(pack(part), 0);
        return;
    }
    for (int r = 1; r < size_; ++r) {
        send_signal(r, kGo);
        join(unpack(receive_bytes(r)));
    }
}

} // namespace keyhole
