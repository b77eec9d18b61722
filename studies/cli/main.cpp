#include "capstan/cli/program.h"

int main(int argument_count, char** arguments) {
    return static_cast<int>(capstan::cli::run_program({arguments + 1, arguments + argument_count}));
}
