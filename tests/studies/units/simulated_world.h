#pragma once
// A cluster without a clock of its own: processes that take turns, a disk, and faults of both.

#include <ucontext.h>

#include <cmath>
#include <exception>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "simulation.h"

namespace capstan::units {

// SplitMix64 (Steele, Lea, Flood 2014).
class Draws {
  public:
    explicit Draws(std::uint64_t seed) : state_(seed) {}
    std::uint64_t next() {
        std::uint64_t z = (state_ += 0x9e3779b97f4a7c15ULL);
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
        return z ^ (z >> 31);
    }
    double uniform() { return static_cast<double>(next() >> 11) * 0x1p-53; }
    double between(double low, double high) { return low + (high - low) * uniform(); }
    int below(int count) { return static_cast<int>(next() % static_cast<std::uint64_t>(count)); }
    bool one_in(double count) { return uniform() * count < 1.0; }

  private:
    std::uint64_t state_;
};

struct Killed : std::exception {};  // leaves a process from wherever it is

struct File {
    std::string text;
    double modified_s = 0.0;
};
using Files = std::map<std::string, std::shared_ptr<File>>;

// How many operations there are between two faults of a kind; 0: none.
struct Rates {
    double fails = 0, fails_after = 0, repeated = 0, kill = 0, stop = 0, flip = 0, loses = 0, clock = 0;
    double seen_late_s = 0;  // a look may be so old
};

class World;

// A worker: the real code, in a context of its own.
struct Process {
    Process(World& its_world, int id, std::optional<int> its_own, double its_speed)
        : world(its_world),
          name("node" + std::to_string(id % 4) + "-" + std::to_string(id)),
          own(its_own),
          speed(its_speed) {}
    World& world;
    std::string name;
    std::optional<int> own;
    double speed;
    double wakes_s = 0.0;
    bool is_dead = false;  // killed: it has no effect any more
    bool has_ended = false;
    std::map<int, std::pair<std::string, double>> hearts;  // file (folder and name), next beat
    int next_heart = 0;
    ucontext_t context{};
    std::unique_ptr<char[]> stack;
    std::string error;
};

class World {
  public:
    explicit World(std::uint64_t seed) : draws_(seed) {}
    Schedule run();
    ClusterRun run_cluster(const Cluster& cluster);

    Draws& draws() { return draws_; }
    double now_s() const { return now_s_; }
    double disk_time_s() const { return now_s_ + clock_offset_s_; }
    Process& current() { return *current_; }
    int units() const { return units_; }
    double unit_s(int unit) const { return unit_s_[static_cast<std::size_t>(unit - 1)]; }

    // ---- What a process calls.
    void wait(double seconds) {
        current_->wakes_s = now_s_ + seconds;
        swapcontext(&current_->context, &main_);
        if (current_->is_dead) throw Killed();
    }
    bool faulty() const { return has_faults_ && now_s_ < faults_end_s_; }
    bool happens(double rate) {
        if (!faulty() || rate <= 0.0 || !draws_.one_in(rate)) return false;
        ++schedule_.faults;
        return true;
    }

    // Around every operation: time passes, others work, something may fail. True: the answer is lost and the
    // request repeated.
    bool begin_operation() {
        if (current_->is_dead) throw Killed();
        ++schedule_.steps;
        wait(draws_.between(1e-4, draws_.one_in(50) ? 2.0 : 5e-3));
        if (happens(rates_.kill)) {
            current_->is_dead = true;
            throw Killed();
        }
        if (happens(rates_.stop)) wait(draws_.between(20.0, 400.0));
        if (happens(rates_.fails)) throw std::runtime_error("Input/output error");
        return happens(rates_.repeated);
    }
    void end_operation() {
        if (current_->is_dead) throw Killed();
        wait(draws_.between(1e-4, 5e-3));
        if (happens(rates_.fails_after)) throw std::runtime_error("Stale file handle");
    }

    Files& files() { return files_; }
    // As this process sees them: from now, or from some time ago.
    const Files& seen() {
        if (rates_.seen_late_s > 0.0 && happens(10.0) && !past_.empty()) {
            const double from_s = now_s_ - draws_.between(0.0, rates_.seen_late_s);
            for (auto at = past_.rbegin(); at != past_.rend(); ++at)
                if (at->first <= from_s) return at->second;
        }
        return files_;
    }
    void changed() {
        if (rates_.seen_late_s > 0.0 && faulty()) {
            Files copy;
            for (const auto& [name, file] : files_) copy[name] = std::make_shared<File>(*file);
            past_.emplace_back(now_s_, std::move(copy));
            if (past_.size() > 64) past_.erase(past_.begin());
        }
    }

    void begun(int unit) { ++begun_[unit]; }
    void published(const std::string& text) {
        ++publications_;
        if (!published_.empty() && published_ != text) say("two results of one study differ");
        published_ = text;
    }
    void say(const std::string& problem) {
        if (schedule_.problem.empty()) schedule_.problem = problem;
    }

    static std::string right_answer(int unit) { return "{\"unit\": " + std::to_string(unit * unit) + "}\n"; }
    std::string input(int unit) const { return "input-" + std::to_string(unit); }

  private:
    friend struct Process;
    void draw_kind();
    void start(std::optional<int> own, double in_s) { start(own, in_s, draws_.one_in(3) ? slowest_ : 1.0); }
    Process& start(std::optional<int> own, double in_s, double speed);
    void resume(Process& process);
    void beat_hearts(double until_s);
    void corrupt();
    void operator_looks();
    void judge();
    static void enter(unsigned high, unsigned low);
    void process_main(Process& process);

    Draws draws_;
    Schedule schedule_;
    Rates rates_;
    Files files_;
    std::vector<std::pair<double, Files>> past_;
    double now_s_ = 0.0, clock_offset_s_ = 0.0, faults_end_s_ = 0.0, slowest_ = 1.0;
    bool has_faults_ = false;
    int units_ = 1, workers_ = 1, next_id_ = 1, publications_ = 0;
    bool is_array_ = false;  // a scheduler starts a task for each unit; else workers take what is free
    std::vector<double> unit_s_;
    std::map<int, int> begun_;
    std::string published_;
    std::vector<std::unique_ptr<Process>> processes_;
    std::vector<std::unique_ptr<char[]>> stacks_;
    Process* current_ = nullptr;
    ucontext_t main_{};
};

}  // namespace capstan::units
