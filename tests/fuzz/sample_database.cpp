#include "sample_database.h"

#include "capstan/cli/program.h"

namespace capstan::fuzz {

namespace {

constexpr const char* config = R"(name = "sample"
repetitions = 40

[transmission]
segments = 4
axial_stiffness_N = 2000
dynamic_friction = 0.2
static_friction = 0.3
pretension_N = 10

[[transmission.curvature]]
length_m = 0.4
bend_radius_m = 0.2

[motion]
samples = 60

[motion.proximal]
amplitude_m = 0.003

[[regime]]
name = "mass"
samples = [5, 45]
duty_fraction = 1

[[noise]]
label = "5 %"
multiplicative_ratio = 0.05

[layouts]
families = ["even"]
counts = [1, 2]

[estimation]
methods = ["mean", "maximum_likelihood"]
)";

}  // namespace

// One thread, so that rows come in the same order: the tables' bits do not depend on it, the file's pages do.
std::filesystem::path make_sample_database(const TemporaryFolder& folder) {
    const auto path = folder.path() / "sample.db";
    const auto study = folder.write("sample.toml", config);
    const auto exit_code = cli::run_program({"study", "run", study, "--db", path, "--jobs", "1", "--progress",
                                             "none", "-o", folder.path() / "sample.txt"});
    if (exit_code != cli::ExitCode::success) throw std::runtime_error("the sample study did not run");
    return path;
}

}  // namespace capstan::fuzz
