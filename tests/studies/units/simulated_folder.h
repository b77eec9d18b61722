#pragma once

#include "capstan/units/shared_folder.h"
#include "simulated_world.h"

namespace capstan::units {

// The folder of leases or that of the results, as a process sees it.
class SimulatedFolder final : public SharedFolder {
  public:
    SimulatedFolder(World& world, Process& process, std::string prefix)
        : world_(world), process_(process), prefix_(std::move(prefix)) {}

    std::string worker() const override { return process_.name; }
    double now_s() override {
        world_.begin_operation();
        const double time_s = world_.disk_time_s();
        world_.end_operation();
        return time_s;
    }
    void pause(double seconds) override { world_.wait(seconds); }
    bool create(const std::string& name, const std::string& text) override {
        const bool repeated = world_.begin_operation();
        const bool is_made = world_.files().count(key(name)) == 0;
        if (is_made) put(name, text);
        world_.end_operation();
        return is_made && !repeated;  // the second request finds what the first one made
    }
    void replace(const std::string& name, const std::string& text) override {
        world_.begin_operation();
        if (name == merged_results) world_.published(text);
        put(name, text);
        world_.end_operation();
    }
    std::optional<std::string> read(const std::string& name) override {
        world_.begin_operation();
        const Files& files = world_.seen();
        const auto found = files.find(key(name));
        std::optional<std::string> text;
        if (found != files.end()) text = found->second->text;
        world_.end_operation();
        return text;
    }
    std::optional<double> modified_s(const std::string& name) override {
        world_.begin_operation();
        const Files& files = world_.seen();
        const auto found = files.find(key(name));
        std::optional<double> time_s;
        if (found != files.end()) time_s = found->second->modified_s;
        world_.end_operation();
        return time_s;
    }
    std::vector<std::string> names() override {
        world_.begin_operation();
        std::vector<std::string> names;
        for (const auto& [name, file] : world_.seen())
            if (name.starts_with(prefix_)) names.push_back(name.substr(prefix_.size()));
        world_.end_operation();
        return names;
    }
    bool rename(const std::string& from, const std::string& to) override {
        const bool repeated = world_.begin_operation();
        const auto found = world_.files().find(key(from));
        const bool is_there = found != world_.files().end();
        if (is_there) {
            world_.files()[key(to)] = found->second;
            world_.files().erase(key(from));
            world_.changed();
        }
        world_.end_operation();
        return is_there && !repeated;
    }
    bool link(const std::string& from, const std::string& to) override {
        const bool repeated = world_.begin_operation();
        const auto found = world_.files().find(key(from));
        const bool can = found != world_.files().end() && world_.files().count(key(to)) == 0;
        if (can) world_.files()[key(to)] = found->second;
        world_.changed();
        world_.end_operation();
        return can && !repeated;
    }
    bool remove(const std::string& name) noexcept override {
        if (process_.is_dead) return false;
        const bool is_there = world_.files().erase(key(name)) > 0;
        world_.changed();
        return is_there;
    }
    std::unique_ptr<Heart> beat(const std::string& name) override {
        class SimulatedHeart final : public Heart {
          public:
            SimulatedHeart(Process& process, int id) : process_(process), id_(id) {}
            ~SimulatedHeart() override { process_.hearts.erase(id_); }

          private:
            Process& process_;
            int id_;
        };
        const int id = process_.next_heart++;
        process_.hearts[id] = {key(name), world_.now_s() + 5.0};
        return std::make_unique<SimulatedHeart>(process_, id);
    }

  private:
    std::string key(const std::string& name) const { return prefix_ + name; }
    void put(const std::string& name, const std::string& text) {
        world_.files()[key(name)] = std::make_shared<File>(File{text, world_.disk_time_s()});
        world_.changed();
    }

    World& world_;
    Process& process_;
    std::string prefix_;
};

}  // namespace capstan::units
