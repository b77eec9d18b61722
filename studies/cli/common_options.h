#pragma once
// Options that mean the same wherever they appear.

#include <filesystem>
#include <string>
#include <vector>

#include "capstan/cli/command.h"
#include "capstan/config/config_reader.h"
#include "capstan/plan/study_plan.h"
#include "capstan/storage/integrity/computed_with.h"

namespace capstan::cli {

extern const Option help_option;
extern const Option database_option;
extern const Option output_option;
/// The same of a command that ends with deliver_answer(), which writes no pictures.
extern const Option answer_output_option;
extern const Option jobs_option;
extern const Option seed_option;
extern const Option repetitions_option;
extern const Option json_option;
extern const Option progress_option;
extern const Option stats_option;
extern const Option simd_option;  ///< see use_stated_simd()
extern const Option segments_option;
extern const Option format_option;
extern const Option page_option;

extern const Argument config_argument;
extern const Argument study_argument;  ///< latest where left out

/// The check of an option that names a file to be written; - is standard output.
void check_writable(const Invocation& invocation, const Option& option);

/// Takes no wider vector instructions than --simd states. Throws UsageError for a width that is not there.
/// Before anything is computed.
void use_stated_simd(const Invocation& invocation);

/// The same; where nothing is stated, what a study was computed with so far, if this processor has it.
void use_simd_of(const Invocation& invocation, const std::vector<storage::Computation>& computations);

/// The configuration that the argument CONFIG names, with --seed, --repetitions and --truth in place of its
/// own.
config::ReadConfig read_config_of(const Invocation& invocation);

extern const Option far_end_option;  ///< read_config_of() obeys it
extern const Option noise_option;

/// Which of the plan's noise levels --noise names; the first if it is not given. Throws UsageError with the
/// nearest label.
int noise_index_of(const StudyPlan& plan, const Invocation& invocation);

extern const Argument log_argument;

/// The parts of a list such as a,b,c, without the empty ones.
std::vector<std::string> split_at_commas(const std::string& listed);

/// The words between blanks.
std::vector<std::string> split_at_blanks(const std::string& text);

/// The numbers in a list such as 1,2,5. Throws UsageError for what is not a number.
std::vector<int> run_numbers(const std::string& listed);

/// True if a file's name is that of a recording (CSV or its JSON sidecar) rather than of a configuration.
bool names_a_recording(const std::filesystem::path& path);

}  // namespace capstan::cli
