#include <fmt/format.h>

#include "capstan/cli/config_consistency.h"

namespace capstan::cli {

namespace {

using bench::BenchPlan;
using bench::Waveform;
using bench::WaveformKind;

// More are a page and a CSV that nobody reads, and a typing error.
constexpr double max_samples = 1e7;

class BenchChecks {
  public:
    BenchChecks(const ReadBench& bench, const std::vector<ConfigProblem>& known)
        : bench_(bench), known_(known) {}

    std::vector<ConfigProblem> run() {
        const BenchPlan& plan = bench_.plan;
        if (const std::string message = friction_problem(plan.cable); sound("cable") && !message.empty())
            problem("cable.static_friction", message);
        if (sound("motor.input") && sound("load.input") && plan.motor_drive == bench::MotorDrive::torque &&
            plan.load_kind == bench::LoadKind::torque) {
            problem(
                "load.input",
                "is \"torque\" and so is the motor's; nothing would say where the pulleys are: drive the motor by "
                "its angle, or let the load be a spring");
        }
        if (sound("sample_rate_Hz") && sound("duration_s") &&
            plan.duration_s * plan.sample_rate_Hz > max_samples)
            problem("duration_s", "makes more than ten million samples; shorten it or lower sample_rate_Hz");
        if (sound("motor")) check_sines("motor", plan.motor);
        if (sound("load") && plan.load_kind != bench::LoadKind::locked) check_sines("load", plan.load);
        return std::move(problems_);
    }

  private:
    bool sound(std::string_view path) const { return cli::sound(known_, path); }

    void problem(const std::string& key, std::string message) {
        const auto line = bench_.lines.find(key);
        problems_.push_back({line == bench_.lines.end() ? 0 : line->second, 0, key, std::move(message)});
    }

    void check_sines(const std::string& section, const Waveform& wave) {
        if (wave.kind != WaveformKind::sines) return;
        const auto same_count = [&](const char* name, std::size_t count) {
            if (count == wave.amplitudes.size()) return;
            problem(section + "." + name,
                    fmt::format("has {} numbers for {} amplitudes; give one for each sine", count,
                                wave.amplitudes.size()));
        };
        same_count("frequencies_Hz", wave.frequency_Hz.size());
        same_count("phases_rad", wave.phase_rad.size());
    }

    const ReadBench& bench_;
    const std::vector<ConfigProblem>& known_;
    std::vector<ConfigProblem> problems_;
};

}  // namespace

std::vector<ConfigProblem> inconsistencies_of(const ReadBench& bench,
                                              const std::vector<ConfigProblem>& known) {
    return BenchChecks(bench, known).run();
}

}  // namespace capstan::cli
