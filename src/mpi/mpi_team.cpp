#include "mpi/mpi_team.h"

#include "mpi/messages.h"
#include "mpi/parcel.h"

#include <chrono>
#include <mpi.h>
#include <thread>

namespace keyhole {
namespace {

constexpr int kGo = 2; // a tag; messages.cpp has 0 and 1

} // namespace

std::optional<std::int64_t> MpiTeam::take_number() {
    try {
        return pulse_.take_number();
    } catch (const TeamLost&) {
        return std::nullopt; // collect() says so, once what is done has been written
    }
}

std::vector<std::vector<char>> MpiTeam::exchange(std::vector<char> part, bool stop) {
    Exchanged all = exchange_bytes(MPI_COMM_WORLD, std::move(part), stop, [this] { pulse_.check_all(); });
    stopped_ = stopped_ || all.stop;
    return std::move(all.parts);
}

void MpiTeam::wait_for_all() {
    MPI_Request request = MPI_REQUEST_NULL;
    MPI_Ibarrier(MPI_COMM_WORLD, &request);
    wait_for(request, [this] { pulse_.check(); });
}

/// On rank 0; the others wait for it. A process that is lost is told of only when the others have written what they
/// have, since the end of one process is that of all.
void MpiTeam::wait_until_all_are_done() {
    const Check check = [this] { pulse_.check(); };
    pulse_.stop_taking();
    if (pulse_.rank() > 0) {
        wait_for(MPI_COMM_WORLD, 0, kGo, check);
        return take_signal(MPI_COMM_WORLD, 0, kGo);
    }
    while (pulse_.others_work()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    check();
    for (int r = 1; r < pulse_.size(); ++r) send_signal(MPI_COMM_WORLD, r, kGo);
}

Picture MpiTeam::collect(Picture part, const std::function<Picture(Picture, Picture)>& join) {
    const Check check = [this] { pulse_.check(); };
    const int rank = pulse_.rank();
    wait_until_all_are_done();
    for (int step = 1; step < pulse_.size(); step *= 2) {
        if (rank % (2 * step) != 0) {
            send_bytes(MPI_COMM_WORLD, rank - step, pack(part), check);
            return {};
        }
        if (rank + step < pulse_.size())
            part = join(std::move(part), unpack(receive_bytes(MPI_COMM_WORLD, rank + step, check)));
    }
    return part;
}

} // namespace keyhole
