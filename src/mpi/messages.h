// Messages whose waiting sleeps in between, since MPI itself waits by asking again and again, on cores that others
// need; and that ends where the other side is lost.
#pragma once

#include <functional>
#include <mpi.h>
#include <optional>
#include <vector>

namespace keyhole {

/// Called while waiting; throws when there is nothing to wait for any more.
using Check = std::function<void()>;

/// Sends a tag alone. Doesn't wait.
void send_signal(MPI_Comm comm, int to, int tag);

/// Looks for a message without taking it.
std::optional<MPI_Status> look_for(MPI_Comm comm, int source, int tag);

/// Waits for one.
MPI_Status wait_for(MPI_Comm comm, int source, int tag, const Check& check);

/// Takes a signal that is there.
void take_signal(MPI_Comm comm, int source, int tag);

/// Waits until a request is done.
void wait_for(MPI_Request& request, const Check& check);

/// Any number of bytes from one process to another.
void send_bytes(MPI_Comm comm, int to, std::vector<char> bytes, const Check& check);
std::vector<char> receive_bytes(MPI_Comm comm, int from, const Check& check);

/// What all processes have sent each other.
struct Exchanged {
    std::vector<std::vector<char>> parts; ///< by rank
    bool stop;                            ///< whether one of them wants to
};
/// Sends each process what all have. @throws InputError for 2 GiB and more together.
Exchanged exchange_bytes(MPI_Comm comm, std::vector<char> part, bool stop, const Check& check);

} // namespace keyhole
