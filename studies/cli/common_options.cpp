#include "capstan/cli/common_options.h"

#include "capstan/config/config_truth.h"

namespace capstan::cli {

const Option help_option{"help", 'h', OptionKind::flag, "", "Explain this command."};
const Option database_option{"db", '\0', OptionKind::text, "FILE", "The results database.", "capstan.db"};
const Option output_option{"output",
                           'o',
                           OptionKind::text,
                           "FILE",
                           "Write the answer to FILE, whole or not at all; - is standard output.",
                           "-"};
const Option jobs_option{"jobs",
                         'j',
                         OptionKind::whole_number,
                         "N",
                         "Threads; 0 takes all processors. Any number gives the same bits.",
                         "0",
                         {},
                         0,
                         1024};
const Option seed_option{"seed",
                         '\0',
                         OptionKind::whole_number,
                         "S",
                         "Seed of all random numbers, instead of the configuration's.",
                         "",
                         {},
                         0,
                         9.2e18};
const Option repetitions_option{"repetitions",
                                '\0',
                                OptionKind::whole_number,
                                "N",
                                "Draws of noise, instead of the configuration's; a few for a quick look.",
                                "",
                                {},
                                2,
                                1e7};
const Option json_option{"json", '\0', OptionKind::flag, "", "Answer in JSON, for a program."};
const Option progress_option{
    "progress",
    '\0',
    OptionKind::text,
    "auto|json|none",
    "On standard error: auto is a bar on a terminal and plain lines elsewhere, json is one object a line.",
    "auto",
    {"auto", "json", "none"}};
const Option stats_option{"stats", '\0', OptionKind::flag, "", "Say on standard error where the time went."};
const Option segments_option{
    "segments",
    '\0',
    OptionKind::whole_number,
    "N",
    "Segments to a cable of a recorded bench's model; friction at rest depends on their "
    "length, from about 100 on hardly.",
    "100",
    {},
    2,
    100000};

const Option page_option{
    "html", '\0', OptionKind::text, "FILE",
    "Also write FILE: one page of figures and numbers that needs no network; open it in a browser."};

const Argument config_argument{
    "CONFIG", "The study's configuration (TOML); `capstan config default` explains every key."};
const Argument study_argument{"STUDY", "Its number, its name (the last one begun under it), or latest.",
                              ArgumentNeed::optional, "latest"};

config::ReadConfig read_config_of(const Invocation& invocation) {
    config::ReadConfig config = config::read_config(invocation.argument("CONFIG"));
    StudyPlan& plan = config.plan;
    if (invocation.has("seed")) plan.seed = static_cast<std::uint64_t>(invocation.whole("seed"));
    if (invocation.has("repetitions")) plan.repetitions = static_cast<int>(invocation.whole("repetitions"));
    if (invocation.has("truth")) plan.truth = config::read_truth(invocation.text("truth"));
    return config;
}

}  // namespace capstan::cli
