// keyhole-mpi: the program on several machines, started by mpirun. `render` is shared out by passes; every other
// subcommand is run by rank 0 alone.
#include "cli/process_group.h"
#include "cli/program.h"
#include "cli/words/tell.h"
#include "core/bytes.h"
#include "core/error.h"
#include "mpi/heartbeat.h"
#include "mpi/messages.h"

#include <fmt/format.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <mpi.h>
#include <thread>
#include <tuple>

namespace keyhole {
namespace {

constexpr int kGo = 2; // a tag; messages.cpp has 0 and 1

/// What others need of a part of a render: its size, metadata and sums.
auto sent_parts(auto& picture) { return std::tie(picture.width, picture.height, picture.metadata, picture.sums); }

std::vector<char> pack(const Picture& part) {
    ByteWriter to;
    std::apply([&](const auto&... value) { (to.put(value), ...); }, sent_parts(part));
    return to.take();
}

Picture unpack(const std::vector<char>& bytes) {
    ByteReader from(bytes);
    Picture part;
    std::apply([&](auto&... value) { (from.get(value), ...); }, sent_parts(part));
    return part;
}

/// All processes of MPI_COMM_WORLD. Rank 0 hands out numbers; films come together in a binary tree.
///
/// Not thread-safe: one thread calls at a time.
class MpiProcessGroup final : public ProcessGroup {
  public:
    int rank() const override { return heartbeat_.rank(); }
    int size() const override { return heartbeat_.size(); }
    std::vector<std::vector<char>> exchange(std::vector<char> part, bool stop) override;
    bool stopped() const override { return stopped_; }
    /// Whether this process has lost touch with rank 0.
    bool is_cut_off() const { return rank() > 0 && heartbeat_.lost(); }
    std::optional<std::int64_t> take_number() override;
    void wait_for_all() override;
    Picture collect(Picture part, const std::function<Picture(Picture, Picture)>& join) override;

  private:
    void wait_until_all_are_done();

    Heartbeat heartbeat_;
    bool stopped_ = false;
};

std::optional<std::int64_t> MpiProcessGroup::take_number() {
    try {
        return heartbeat_.take_number();
    } catch (const ProcessLost&) {
        return std::nullopt; // collect() says so, once what is done has been written
    }
}

std::vector<std::vector<char>> MpiProcessGroup::exchange(std::vector<char> part, bool stop) {
    Exchanged all = exchange_bytes(MPI_COMM_WORLD, std::move(part), stop, [this] { heartbeat_.check_all(); });
    stopped_ = stopped_ || all.stop;
    return std::move(all.parts);
}

void MpiProcessGroup::wait_for_all() {
    MPI_Request request = MPI_REQUEST_NULL;
    MPI_Ibarrier(MPI_COMM_WORLD, &request);
    wait_for(request, [this] { heartbeat_.check(); });
}

/// On rank 0; the others wait for it. A process that is lost is told of only when the others have written what they
/// have, since the end of one process is that of all.
void MpiProcessGroup::wait_until_all_are_done() {
    const Check check = [this] { heartbeat_.check(); };
    heartbeat_.stop_taking();
    if (heartbeat_.rank() > 0) {
        wait_for(MPI_COMM_WORLD, 0, kGo, check);
        return take_signal(MPI_COMM_WORLD, 0, kGo);
    }
    while (heartbeat_.others_work()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    check();
    for (int r = 1; r < heartbeat_.size(); ++r) send_signal(MPI_COMM_WORLD, r, kGo);
}

Picture MpiProcessGroup::collect(Picture part, const std::function<Picture(Picture, Picture)>& join) {
    const Check check = [this] { heartbeat_.check(); };
    const int rank = heartbeat_.rank();
    wait_until_all_are_done();
    for (int step = 1; step < heartbeat_.size(); step *= 2) {
        if (rank % (2 * step) != 0) {
            send_bytes(MPI_COMM_WORLD, rank - step, pack(part), check);
            return {};
        }
        if (rank + step < heartbeat_.size())
            part = join(std::move(part), unpack(receive_bytes(MPI_COMM_WORLD, rank + step, check)));
    }
    return part;
}

int run(int argc, char** argv) {
    try {
        MpiProcessGroup group;
        const int code = run_program(argc, argv, &group);
        if (code != kInternalError && code != kBadInput) return code;
        // Who is cut off from the others can't end them, and would wait for leave to end itself.
        std::fflush(nullptr);
        if (group.is_cut_off()) std::_Exit(code);
        MPI_Abort(MPI_COMM_WORLD, code); // the others would wait for this one
    } catch (const InputError& e) {
        tell("keyhole: {}\n", e.what());
        MPI_Abort(MPI_COMM_WORLD, kBadInput);
    }
    return kInternalError;
}

} // namespace
} // namespace keyhole

int main(int argc, char** argv) {
    int provided = 0;
    MPI_Init_thread(&argc, &argv, MPI_THREAD_MULTIPLE, &provided);
    if (provided < MPI_THREAD_MULTIPLE) MPI_Abort(MPI_COMM_WORLD, keyhole::kInternalError);
    const int code = keyhole::run(argc, argv);
    MPI_Finalize();
    return code;
}
