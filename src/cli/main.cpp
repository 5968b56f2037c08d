// keyhole
#include "cli/program.h"

int main(int argc, char** argv) { return keyhole::run_program(argc, argv, nullptr); }
