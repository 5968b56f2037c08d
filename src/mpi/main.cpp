// keyhole-mpi: the program on several machines, started by mpirun. `render` is shared out by passes; every other
// subcommand is run by rank 0 alone.
#include "cli/program.h"
#include "mpi/mpi_team.h"

#include <mpi.h>

int main(int argc, char** argv) {
    int provided = 0;
    MPI_Init_thread(&argc, &argv, MPI_THREAD_MULTIPLE, &provided);
    if (provided < MPI_THREAD_MULTIPLE) MPI_Abort(MPI_COMM_WORLD, keyhole::kInternalError);
    int code = keyhole::kInternalError;
    {
        keyhole::MpiTeam team;
        code = keyhole::run_program(argc, argv, &team);
        // The others would wait for this one.
        if (code == keyhole::kInternalError || code == keyhole::kBadInput) MPI_Abort(MPI_COMM_WORLD, code);
    }
    MPI_Finalize();
    return code;
}
