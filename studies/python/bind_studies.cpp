#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <memory>

#include "arrays.h"
#include "bindings.h"
#include "capstan/answers/placement_answers.h"
#include "capstan/answers/recording_answers.h"
#include "capstan/config/config_reader.h"
#include "capstan/config/plan_checks.h"
#include "capstan/paper/placement_comparison.h"
#include "capstan/placement/study_run.h"
#include "capstan/reports/page_frame.h"
#include "capstan/search/sensor_placement.h"
#include "capstan/storage/read_only_query.h"
#include "capstan/worlds/diagnosed_world.h"
#include "capstan/worlds/stored_worlds.h"
#include "long_call.h"
#include "signatures.h"

namespace capstan::python {

namespace {

using config::ReadConfig;

ReadConfig with_settings(ReadConfig config, const OptionalInteger& seed, const OptionalInteger& repetitions) {
    constexpr IntegerRange seeds{0, 9200000000000000000};
    constexpr IntegerRange counts{2, 10000000};
    if (!seed.is_none()) config.plan.seed = static_cast<std::uint64_t>(integer_of(seed, "seed", seeds));
    if (!repetitions.is_none())
        config.plan.repetitions = static_cast<int>(integer_of(repetitions, "repetitions", counts));
    return config;
}

RunOptions run_options(int jobs, CallWatch& watch) {
    RunOptions options;
    options.jobs = jobs;
    options.stop = &watch.stop();
    options.compare_with_paper = paper::compare_placement;
    options.on_progress = [&watch](const StudyProgress& progress) {
        watch.tell("study",
                   progress.units > 0 ? static_cast<double>(progress.units_done) / progress.units : 0.0);
    };
    return options;
}

TableOptions table_options(int jobs, CallWatch& watch) {
    TableOptions options;
    options.jobs = jobs;
    options.stop = &watch.stop();
    options.on_progress = [&watch](const TableProgress& progress) {
        watch.tell(std::string(progress.activity),
                   progress.total > 0.0 ? progress.done / progress.total : 0.0);
    };
    return options;
}

// The studies of a configuration, each stored with its number.
std::vector<std::int64_t> run(const ReadConfig& config, const std::filesystem::path& file,
                              const OptionalInteger& seed, const OptionalInteger& repetitions,
                              const Integer& jobs, const Progress& on_progress) {
    const auto ids = std::make_shared<std::vector<std::int64_t>>();
    const ReadConfig asked = with_settings(config, seed, repetitions);
    const int threads = jobs_of(jobs);
    run_long_call(on_progress, [=](CallWatch& watch) {
        const std::vector<StudyPlan> plans = config::runnable_studies(asked);
        storage::Database database = storage::Database::open_or_create(file);
        const std::string version = reports::program_version();
        if (plans.front().uncertainty.is_stated) {
            for (const StudyPlan& plan : plans) ids->push_back(begin_worlds(database, plan, version));
            for (std::size_t k = 0; k < plans.size(); ++k)
                run_worlds(database, (*ids)[k], plans[k], table_options(threads, watch));
            return;
        }
        for (const StudyPlan& plan : plans)
            ids->push_back(run_study(database, plan, version, run_options(threads, watch)).study_id);
    });
    return *ids;
}

std::shared_ptr<reports::Answer> conclusions(const std::filesystem::path& file, std::int64_t study_id) {
    const py::gil_scoped_release others_run;
    storage::Database database = storage::Database::open_read_only(file);
    return std::make_shared<reports::Answer>(answers::conclusions_answer(database, study_id));
}

py::object value_of(const storage::QueryValue& value) {
    if (const auto* integer = std::get_if<std::int64_t>(&value)) return py::int_(*integer);
    if (const auto* number = std::get_if<double>(&value)) return py::float_(*number);
    if (const auto* text = std::get_if<std::string>(&value)) return py::str(*text);
    return py::none();
}

// Column names, and the rows as tuples.
std::pair<std::vector<std::string>, Rows> query(const std::filesystem::path& file, const std::string& sql) {
    storage::QueryResult result;
    {
        const py::gil_scoped_release others_run;
        storage::Database database = storage::Database::open_read_only(file);
        result = storage::run_read_only(database, sql);
    }
    py::list rows;
    for (const auto& row : result.rows) {
        py::tuple values(row.size());
        for (std::size_t k = 0; k < row.size(); ++k) values[k] = value_of(row[k]);
        rows.append(values);
    }
    return {result.columns, Rows(rows)};
}

int noise_index(const StudyPlan& plan, const std::optional<std::string>& label) {
    if (!label) return 0;
    std::string known;
    for (std::size_t k = 0; k < plan.noise_levels.size(); ++k) {
        if (plan.noise_levels[k].label == *label) return static_cast<int>(k);
        known += (k == 0 ? "" : ", ") + plan.noise_levels[k].label;
    }
    throw InvalidInput({"noise: the configuration has no noise level '" + *label + "'; it has " + known});
}

reports::Answer placed_at_instants(const ReadConfig& config, const PlacementOptions& options) {
    config::require_runnable(config);
    return answers::place_answer(config.plan, place_sensors(config.plan, options));
}

// Whether the advice changes where the worlds lie about what a diagnosis found.
reports::Answer placed_about(const DiagnosedWorld& found, ReadConfig config, const TableOptions& options) {
    if (!config.plan.uncertainty.is_stated)
        throw InvalidInput({"world: needs a configuration with [uncertainty], whose worlds it changes"});
    config.plan.truth = {};
    config::require_runnable(config);
    const WorldAnswer nominal = run_worlds(config.plan, options);
    config.plan.truth = found.truth;
    config.plan.uncertainty.truth_probability = found.probability;
    config::require_runnable(config);
    return answers::world_truth_answer(config.plan, nominal, run_worlds(config.plan, options));
}

// What a diagnosis says of the worlds; a warning names what it cannot say.
std::optional<DiagnosedWorld> world_about(const std::shared_ptr<PythonDiagnosis>& found,
                                          CableArrangement arrangement) {
    if (found == nullptr) return {};
    const auto& split = found->runs.split;
    DiagnosedWorld world = world_of(answers::diagnosis_record(split.diagnosed, split.diagnosis), arrangement);
    for (const std::string& cause : world.left_out) {
        const std::string words = cause + " is not of the cable and is left out.";
        if (PyErr_WarnEx(PyExc_UserWarning, words.c_str(), 3) != 0) throw py::error_already_set();
    }
    return world;
}

std::shared_ptr<reports::Answer> place(const ReadConfig& config,
                                       const std::optional<std::shared_ptr<PythonDiagnosis>>& found,
                                       const std::optional<std::string>& noise, const Integer& runners_up,
                                       const OptionalNumber& resolve_to_N, const OptionalInteger& seed,
                                       const OptionalInteger& repetitions, const Integer& jobs,
                                       const Progress& on_progress) {
    auto answer = std::make_shared<reports::Answer>();
    const ReadConfig asked = with_settings(config, seed, repetitions);
    const bool of_worlds = asked.plan.uncertainty.is_stated;
    if (of_worlds && (noise || !resolve_to_N.is_none()))
        throw InvalidInput(
            {std::string(noise ? "noise" : "resolve_to_N") +
             ": is for studies at instants; a study with [uncertainty] compares sets of sensors "
             "over complete motions"});
    PlacementOptions options;
    options.jobs = jobs_of(jobs);
    options.noise_index = of_worlds ? 0 : noise_index(asked.plan, noise);
    options.runners_up = static_cast<int>(integer_of(runners_up, "runners_up", {0, 1000}));
    if (!resolve_to_N.is_none()) options.resolve_to_N = number_of(resolve_to_N, "resolve_to_N");
    if (options.resolve_to_N && !(*options.resolve_to_N >= 1e-6 && *options.resolve_to_N <= 1e6))
        throw InvalidInput({"resolve_to_N: must be 1e-6 to 1e6 N"});
    const std::optional<DiagnosedWorld> world =
        world_about(found.value_or(nullptr), config.plan.transmission.arrangement);
    run_long_call(on_progress, [=](CallWatch& watch) mutable {
        options.on_progress = [&](const std::string& activity) { watch.tell(activity, 0.0); };
        if (world) {
            *answer = placed_about(*world, asked, table_options(options.jobs, watch));
        } else if (of_worlds) {
            config::require_runnable(asked);
            *answer =
                answers::world_answer(asked.plan, run_worlds(asked.plan, table_options(options.jobs, watch)));
        } else {
            *answer = placed_at_instants(asked, options);
        }
    });
    return answer;
}

}  // namespace

void bind_studies(py::module_& module) {
    using namespace py::literals;
    py::class_<ReadConfig, std::shared_ptr<ReadConfig>>(module, "Config")
        .def_property_readonly("name", [](const ReadConfig& config) { return config.plan.name; })
        .def("run", &run, "db"_a, "seed"_a, "repetitions"_a, "jobs"_a, "on_progress"_a)
        .def("place", &place, "world"_a, "noise"_a, "runners_up"_a, "resolve_to_N"_a, "seed"_a,
             "repetitions"_a, "jobs"_a, "on_progress"_a);
    module.def("read_config", &config::read_config, "file"_a);
    module.def(
        "parse_config", [](const std::string& toml) { return config::parse_config(toml, "the text"); },
        "toml"_a);
    module.def("conclusions", &conclusions, "db"_a, "study_id"_a);
    module.def("query", &query, "db"_a, "sql"_a);
}

}  // namespace capstan::python
