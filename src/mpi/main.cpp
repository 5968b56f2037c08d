// keyhole-mpi: the program on several machines, started by mpirun. `render` is shared out by passes; every other
// subcommand is run by rank 0 alone.
#include "cli/program.h"
#include "cli/words/tell.h"
#include "core/error.h"
#include "mpi/mpi_process_group.h"

#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>
#include <mpi.h>

namespace {

int run(int argc, char** argv) {
    using namespace keyhole;
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

int main(int argc, char** argv) {
    int provided = 0;
    MPI_Init_thread(&argc, &argv, MPI_THREAD_MULTIPLE, &provided);
    if (provided < MPI_THREAD_MULTIPLE) MPI_Abort(MPI_COMM_WORLD, keyhole::kInternalError);
    const int code = run(argc, argv);
    MPI_Finalize();
    return code;
}
