#include "simulated_machine.h"

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <iterator>

namespace capstan::faults {

namespace fs = std::filesystem;

namespace {

constexpr unsigned longest_s = 120;  // of one process, asleep or not

std::string bytes_of(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

void write_bytes(const fs::path& path, const std::string& bytes) {
    std::ofstream(path, std::ios::binary) << bytes;
}

}  // namespace

Machine::Machine(std::uint64_t seed, const fs::path& folder)
    : draws(seed), root(folder / "root"), durable_(folder / "durable"), said_(folder / "said") {
    fs::remove_all(root);
    fs::remove_all(durable_);
    fs::create_directories(root);
    fs::create_directories(durable_);
}

Planned Machine::some_fault(int operations) {
    constexpr Fault faults[] = {Fault::error, Fault::full,       Fault::torn,
                                Fault::kill,  Fault::kill_after, Fault::stop};
    Planned planned;
    planned.fault = faults[draws.below(static_cast<int>(std::size(faults)))];
    planned.at = 1 + draws.below(operations);
    return planned;
}

bool Machine::start(const Planned& planned, const std::function<void()>& body, Ended& ended) {
    ++run.processes;
    fs::remove(said_);
    const pid_t process = ::fork();
    if (process == 0) {
        ::alarm(longest_s);
        arm(planned, root, durable_);
        try {
            body();
        } catch (const std::exception& error) {
            write_bytes(said_, error.what());
            ::_exit(3);
        }
        ::_exit(0);
    }
    return wait_for(process, ended);
}

bool Machine::wait_for(pid_t process, Ended& ended) {
    int status = 0;
    ::waitpid(process, &status, WUNTRACED);
    if (WIFSTOPPED(status)) {
        halted_.push_back(process);
        return false;
    }
    ended.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    ended.said = ended.code == 3 ? bytes_of(said_) : "";
    if (ended.code != 0) ++run.faults;
    if (ended.code == 128 + SIGALRM) run.problem = "a process hangs";
    if (WIFSIGNALED(status) && ended.code != 128 + SIGKILL && ended.code != 128 + SIGALRM)
        run.problem = "a process crashed with signal " + std::to_string(WTERMSIG(status));
    return true;
}

bool Machine::go_on(Ended& ended) {
    const auto at = halted_.begin() + draws.below(static_cast<int>(halted_.size()));
    const pid_t process = *at;
    halted_.erase(at);
    ::kill(process, SIGCONT);
    return wait_for(process, ended);
}

void Machine::kill_one() {
    const auto at = halted_.begin() + draws.below(static_cast<int>(halted_.size()));
    ::kill(*at, SIGKILL);
    ::waitpid(*at, nullptr, 0);
    halted_.erase(at);
    ++run.faults;
}

fs::path Machine::copy_of(const fs::path& path) const {
    std::string name = path.string().substr(root.string().size() + 1);
    std::replace(name.begin(), name.end(), '/', '\\');
    return durable_ / name;
}

void Machine::sync_all() {
    for (const fs::path& path : files([](const std::string&) { return true; }))
        write_bytes(copy_of(path), bytes_of(path));
}

void Machine::cut_power(const std::function<bool(const std::string&)>& takes) {
    while (has_halted()) kill_one();
    ++run.faults;
    constexpr std::size_t block = 4096;
    for (const fs::path& path : files(takes)) {
        if (path.string().ends_with("-shm")) {
            fs::remove(path);
            continue;
        }
        const std::string now = bytes_of(path), kept = bytes_of(copy_of(path));
        if (now == kept) continue;
        std::string left = draws.one_in(2) ? now : kept;  // of its length
        for (std::size_t at = 0; at < left.size(); at += block) {
            const std::string& from = draws.one_in(2) ? now : kept;
            const std::size_t size = std::min(block, left.size() - at);
            if (at < from.size())
                left.replace(at, size, from.substr(at, size).append(size, '\0').substr(0, size));
        }
        write_bytes(path, left);
        write_bytes(copy_of(path), left);
    }
}

void Machine::flip_a_bit(const fs::path& file) {
    std::string bytes = bytes_of(file);
    if (bytes.empty()) return;
    const auto at = static_cast<std::size_t>(draws.next() % bytes.size());
    bytes[at] = static_cast<char>(bytes[at] ^ (1 << draws.below(8)));
    write_bytes(file, bytes);
    ++run.faults;
}

std::vector<fs::path> Machine::files(const std::function<bool(const std::string&)>& takes) const {
    std::vector<fs::path> found;
    for (const auto& entry : fs::recursive_directory_iterator(root))
        if (entry.is_regular_file() && takes(entry.path().filename().string())) found.push_back(entry.path());
    std::sort(found.begin(), found.end());
    return found;
}

}  // namespace capstan::faults
