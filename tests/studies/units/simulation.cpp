#include "simulation.h"

#include <algorithm>
#include <set>

#include "capstan/units/lease.h"
#include "capstan/units/result_units.h"
#include "capstan/units/unit_record.h"
#include "capstan/units/unit_worker.h"
#include "simulated_folder.h"

namespace capstan::units {

void World::draw_kind() {
    units_ = 1 + draws_.below(6);
    workers_ = 1 + draws_.below(4);
    is_array_ = draws_.one_in(2);
    const double typical_s = std::exp(draws_.between(std::log(0.05), std::log(200.0)));
    for (int unit = 1; unit <= units_; ++unit) unit_s_.push_back(typical_s * draws_.between(0.5, 1.5));
    has_faults_ = !draws_.one_in(4);
    const auto rate = [&](double usual) { return draws_.one_in(2) ? usual * draws_.between(0.3, 3.0) : 0.0; };
    rates_ = {.fails = rate(60),
              .fails_after = rate(60),
              .repeated = rate(20),
              .kill = rate(100),
              .stop = rate(100),
              .flip = rate(40),
              .loses = rate(100),
              .clock = rate(200),
              .seen_late_s = draws_.one_in(2) ? 60.0 : 0.0};
    if (has_faults_ && draws_.one_in(3)) slowest_ = 10.0;
    faults_end_s_ = draws_.between(5.0, 20.0 * typical_s + 500.0);
    schedule_.kind = std::to_string(units_) + " units of about " + std::to_string(typical_s) + " s, " +
                     std::to_string(workers_) + (is_array_ ? " nodes of a scheduler" : " workers") +
                     (has_faults_ ? "" : ", no faults");
}

void World::enter(unsigned high, unsigned low) {
    auto* process = reinterpret_cast<Process*>((static_cast<std::uintptr_t>(high) << 32) | low);
    process->world.process_main(*process);
}

// The real worker.
void World::process_main(Process& process) {
    try {
        SimulatedFolder leases(*this, process, "leases/");
        SimulatedFolder results(*this, process, "");
        ResultUnits units{"", {}, "SIMD AVX2"};
        for (int unit = 1; unit <= units_; ++unit) units.inputs.push_back(input(unit));
        ResultWork result_work(
            leases, results, units,
            [&](int unit, const std::function<bool()>& is_unwanted) -> Result {
                begun(unit);
                const double needs_s = unit_s(unit) * process.speed;
                for (double done_s = 0.0; done_s < needs_s; done_s += 2.0) {
                    wait(std::min(2.0, needs_s - done_s));
                    if (is_unwanted()) return {WorkEnd::stopped};
                }
                return {WorkEnd::complete, right_answer(unit)};
            },
            [] { return false; });
        work(leases, result_work, process.own, WorkerOptions{});
    } catch (const Killed&) {
    } catch (const std::exception& error) {
        process.error = error.what();
    }
    process.hearts.clear();
    process.has_ended = true;
    swapcontext(&process.context, &main_);
}

Process& World::start(std::optional<int> own, double in_s, double speed) {
    processes_.push_back(std::make_unique<Process>(*this, next_id_++, own, speed));
    Process& process = *processes_.back();
    process.wakes_s = now_s_ + in_s;
    constexpr std::size_t stack_bytes = 256 << 10;
    if (stacks_.empty()) stacks_.push_back(std::make_unique_for_overwrite<char[]>(stack_bytes));
    process.stack = std::move(stacks_.back());
    stacks_.pop_back();
    getcontext(&process.context);
    process.context.uc_stack.ss_sp = process.stack.get();
    process.context.uc_stack.ss_size = stack_bytes;
    process.context.uc_link = nullptr;
    const auto address = reinterpret_cast<std::uintptr_t>(&process);
    makecontext(&process.context, reinterpret_cast<void (*)()>(&World::enter), 2,
                static_cast<unsigned>(address >> 32), static_cast<unsigned>(address));
    return process;
}

void World::resume(Process& process) {
    current_ = &process;
    swapcontext(&main_, &process.context);
    current_ = nullptr;
}

// Hearts of processes that are not stopped: a stopped one has a wake far away, and its heart stands still.
void World::beat_hearts(double until_s) {
    for (const auto& process : processes_) {
        if (process->has_ended || process->is_dead || process->wakes_s > until_s + 15.0) continue;
        for (auto& [id, heart] : process->hearts) {
            if (heart.second > until_s) continue;
            heart.second = until_s + 5.0;
            if (const auto file = files_.find(heart.first); file != files_.end()) {
                file->second->modified_s = disk_time_s();
                changed();
            }
        }
    }
}

// What a disk and its clock do by themselves.
void World::corrupt() {
    if (happens(rates_.flip * 20) && !files_.empty()) {
        auto at = files_.begin();
        std::advance(at, draws_.below(static_cast<int>(files_.size())));
        // The merged result is the end of what is simulated: doctor and status compare it with its hashes.
        if (at->first != merged_results && !at->second->text.empty()) {
            std::string text = at->second->text;
            text[static_cast<std::size_t>(draws_.below(static_cast<int>(text.size())))] ^=
                static_cast<char>(1 << draws_.below(8));
            at->second = std::make_shared<File>(File{text, at->second->modified_s});
        }
    }
    if (happens(rates_.loses * 20) && !files_.empty()) {  // the newest file
        auto newest = std::max_element(files_.begin(), files_.end(), [](const auto& a, const auto& b) {
            return a.second->modified_s < b.second->modified_s;
        });
        if (newest->first != merged_results) files_.erase(newest);
    }
    if (happens(rates_.clock * 20)) clock_offset_s_ += draws_.between(-600.0, 600.0);
}

// The scheduler or a person: starts what seems to be missing, sometimes what is not.
void World::operator_looks() {
    if (files_.count(merged_results) != 0) return;
    int alive = 0;
    std::set<int> own;
    for (const auto& process : processes_) {
        if (process->has_ended || process->is_dead) continue;
        ++alive;
        if (process->own) own.insert(*process->own);
    }
    if (is_array_) {
        for (int unit = 1; unit <= units_; ++unit) {
            if (files_.count("leases/" + done_file_of(unit)) != 0 && alive > 0) continue;
            if (own.count(unit) != 0 && !happens(20)) continue;  // else: started twice
            if (happens(10)) continue;                           // lost
            if (alive++ < 8) start(unit, draws_.between(0.0, 3.0));
        }
    } else if (alive < workers_) {
        start(std::nullopt, draws_.between(0.0, 3.0));
    }
}

void World::judge() {
    const auto merged = files_.find(merged_results);
    if (merged == files_.end()) {
        std::string names;
        for (const auto& [name, file] : files_) names += " " + name;
        for (const auto& process : processes_)
            if (!process->error.empty()) names = " (last error: " + process->error + ")" + names;
        return say("the result does not come:" + names);
    }
    const std::string& text = merged->second->text;
    for (const std::string& problem : problems_of_results(text)) say("merged result: " + problem);
    std::size_t at = 0;
    for (int unit = 1; unit <= units_; ++unit) {
        const std::string right = "\"input\": \"" + input(unit) + "\"";
        at = text.find(right, at);
        if (at == std::string::npos || text.find(right, at + 1) != std::string::npos)
            return say("unit " + std::to_string(unit) + " is lost or doubled in the result");
        const std::string answer = "\n\"answer\":\n" + right_answer(unit) + "}";
        if (text.find(answer, at) != text.find("\n\"answer\":", at))
            return say("unit " + std::to_string(unit) + " has another unit's answer");
    }
    if (has_faults_) return;
    for (int unit = 1; unit <= units_; ++unit)
        if (begun_[unit] != 1)
            say("unit " + std::to_string(unit) + " was begun " + std::to_string(begun_[unit]) +
                " times, though nothing failed");
    if (publications_ != 1) say("merged " + std::to_string(publications_) + " times, though nothing failed");
    for (const auto& [name, file] : files_)
        if (name.starts_with("leases/") && !name.ends_with(".done")) say(name + " was left behind");
    for (const auto& process : processes_)
        if (!process->error.empty()) say("a worker ended with: " + process->error);
}

Schedule World::run() {
    draw_kind();
    if (is_array_)
        for (int unit = 1; unit <= units_; ++unit) {
            if (!happens(10)) start(unit, draws_.between(0.0, 2.0));
            if (happens(20)) start(unit, draws_.between(0.0, 100.0));
        }
    else
        for (int k = 0; k < workers_; ++k) start(std::nullopt, draws_.between(0.0, 2.0));
    double next_look_s = 30.0;
    constexpr double end_s = 1e5;
    constexpr long max_steps = 2'000'000;
    while (now_s_ < end_s && schedule_.steps < max_steps) {
        Process* next = nullptr;
        for (const auto& process : processes_)
            if (!process->has_ended && (next == nullptr || process->wakes_s < next->wakes_s))
                next = process.get();
        if (next == nullptr && files_.count(merged_results) != 0) break;
        if (next == nullptr || next->wakes_s > next_look_s) {
            now_s_ = next_look_s;
            next_look_s += 30.0;
            beat_hearts(now_s_);
            operator_looks();
            continue;
        }
        now_s_ = std::max(now_s_, next->wakes_s);
        beat_hearts(now_s_);
        if (faulty()) corrupt();
        resume(*next);
        if (next->has_ended) {
            stacks_.push_back(std::move(next->stack));
            if (!next->error.empty() || next->is_dead) continue;
        }
    }
    // Whoever still runs is ended, so that its objects are.
    for (const auto& process : processes_) {
        if (process->has_ended) continue;
        process->is_dead = true;
        resume(*process);
    }
    judge();
    return schedule_;
}

// Time goes on by the next process; whoever waits for the others at the end is not needed for the result.
ClusterRun World::run_cluster(const Cluster& cluster) {
    units_ = cluster.units;
    ClusterRun run;
    for (int unit = 1; unit <= units_; ++unit) {
        unit_s_.push_back(cluster.unit_s * draws_.between(0.5, 1.5));
        run.ideal_s += unit_s_.back();
    }
    struct Node {
        double speed = 1.0;
        double dies_at_s = 1e300;
        Process* task = nullptr;
    };
    std::vector<Node> nodes(static_cast<std::size_t>(cluster.nodes));
    nodes.front().speed = cluster.slow_factor;
    if (cluster.node_dies_at_s > 0.0) nodes.back().dies_at_s = cluster.node_dies_at_s;
    double power = 0.0;
    for (const Node& node : nodes)
        if (node.dies_at_s > 1e200) power += 1.0 / node.speed;
    run.ideal_s /= power;
    std::vector<int> queue;
    for (int unit = units_; unit >= 1; --unit) queue.push_back(unit);
    while (files_.count(merged_results) == 0 && now_s_ < 1e7) {
        Node* next = nullptr;
        for (Node& node : nodes) {
            if (node.task != nullptr && node.task->has_ended) node.task = nullptr;
            if (node.dies_at_s <= now_s_) {
                if (node.task != nullptr) {
                    queue.push_back(*node.task->own);
                    node.task->is_dead = true;
                    resume(*node.task);
                    node.task = nullptr;
                }
                continue;
            }
            if (node.task == nullptr && !queue.empty()) {
                node.task = &start(queue.back(), 0.1, node.speed);
                queue.pop_back();
            }
            if (node.task != nullptr && (next == nullptr || node.task->wakes_s < next->task->wakes_s))
                next = &node;
        }
        if (next == nullptr) break;
        now_s_ = std::max(now_s_, next->task->wakes_s);
        beat_hearts(now_s_);
        resume(*next->task);
        if (next->task->has_ended) stacks_.push_back(std::move(next->task->stack));
        std::erase_if(processes_, [&](const auto& each) {
            return each->has_ended && std::none_of(nodes.begin(), nodes.end(),
                                                   [&](const Node& node) { return node.task == each.get(); });
        });
    }
    run.wall_s = now_s_;
    for (const auto& process : processes_) {
        if (process->has_ended) continue;
        process->is_dead = true;
        resume(*process);
    }
    has_faults_ = true;  // a late unit is begun twice
    judge();
    run.problem = schedule_.problem;
    return run;
}

ClusterRun simulate_cluster(const Cluster& cluster, std::uint64_t seed) {
    return World(seed).run_cluster(cluster);
}

Schedule simulate(std::uint64_t seed) {
    return World(seed).run();
}

}  // namespace capstan::units
