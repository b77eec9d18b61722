// Makes a text file and a ROS 1 bag of a gigabyte (or as many megabytes as stated), reads each in a process
// of its own, imports each with the program where that is named, and prints how long that took and its peak
// memory: read_logs FOLDER [MEGABYTES [CAPSTAN]]
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <string>

#include "capstan/logs/log.h"

namespace {

constexpr std::size_t chunk_bytes = 768u << 10;  // as rosbag record has it

void write_text(const std::filesystem::path& path, std::size_t bytes) {
    std::ofstream file(path, std::ios::binary);
    file
        << "time [s],motor angle [rad],motor torque [N m],load angle [rad],load torque [N m],tension 1 [N],tension 2 [N]\n";
    std::string block;
    std::size_t written = 0;
    for (long row = 0; written < bytes; ++row) {
        char line[160];
        const double t = 1e-3 * static_cast<double>(row), wave = static_cast<double>(row % 6283) * 1e-3;
        block.append(line, static_cast<std::size_t>(
                               std::snprintf(line, sizeof line, "%.3f,%.6f,%.6f,%.6f,%.6f,%.4f,%.4f\n", t,
                                             wave, 0.1 + wave, 0.9 * wave, -wave, 20.0 + wave, 21.0 - wave)));
        if (block.size() < chunk_bytes) continue;
        file << block;
        written += block.size();
        block.clear();
    }
}

template <typename Number>
void put(std::string& to, Number number) {
    to.append(reinterpret_cast<const char*>(&number), sizeof number);
}
void put_text(std::string& to, const std::string& text) {
    put(to, static_cast<std::uint32_t>(text.size()));
    to += text;
}
template <typename Number>
std::string field(const std::string& name, Number number) {
    std::string bytes = name + "=";
    put(bytes, number);
    return bytes;
}
std::string record(const std::initializer_list<std::string>& fields, const std::string& data) {
    std::string header, bytes;
    for (const std::string& one : fields) put_text(header, one);
    put_text(bytes, header);
    put_text(bytes, data);
    return bytes;
}

std::string connection() {
    const std::string rule(80, '=');
    std::string about;
    put_text(about, "topic=/joint_states");
    put_text(about, "type=sensor_msgs/JointState");
    put_text(about, "md5sum=3066dcd76a6cfaef579bd0f34173e9fd");
    put_text(
        about,
        "message_definition=Header header\nstring[] name\nfloat64[] position\nfloat64[] velocity\nfloat64[] effort\n" +
            rule + "\nMSG: std_msgs/Header\nuint32 seq\ntime stamp\nstring frame_id\n");
    return record({field("op", std::uint8_t{7}), field("conn", std::uint32_t{0}), "topic=/joint_states"},
                  about);
}

std::string message(std::uint32_t number) {
    const std::uint32_t seconds = 1700000000 + number / 1000, nanoseconds = number % 1000 * 1000000;
    std::string data;
    put(data, number);
    put(data, seconds);
    put(data, nanoseconds);
    put_text(data, "base_link");
    put(data, std::uint32_t{3});
    for (const char* joint : {"shoulder", "elbow", "wrist"}) put_text(data, joint);
    for (int array = 0; array < 3; ++array) {
        put(data, std::uint32_t{3});
        for (int joint = 0; joint < 3; ++joint) put(data, array + 0.1 * joint + 1e-3 * number);
    }
    const std::uint64_t time = seconds | static_cast<std::uint64_t>(nanoseconds) << 32;
    return record({field("op", std::uint8_t{2}), field("conn", std::uint32_t{0}), field("time", time)}, data);
}

void write_bag(const std::filesystem::path& path, std::size_t bytes) {
    std::ofstream file(path, std::ios::binary);
    file << "#ROSBAG V2.0\n";
    file << record({field("op", std::uint8_t{3}), field("index_pos", std::uint64_t{0}),
                    field("conn_count", std::uint32_t{0}), field("chunk_count", std::uint32_t{0})},
                   std::string(4027, ' '));
    std::string chunk = connection();
    std::size_t written = 0;
    for (std::uint32_t number = 0; written < bytes; ++number) {
        chunk += message(number);
        if (chunk.size() < chunk_bytes) continue;
        file << record({field("op", std::uint8_t{5}), "compression=none",
                        field("size", static_cast<std::uint32_t>(chunk.size()))},
                       chunk);
        written += chunk.size();
        chunk.clear();
    }
}

const char* const text_mapping = R"([channels]
motor_angle = { column = "motor angle", unit = "rad" }
motor_torque = { column = "motor torque", unit = "N m" }
load_angle = { column = "load angle", unit = "rad" }
load_torque = { column = "load torque", unit = "N m" }
[recording]
mode = "lumped_drive"
)";
const char* const bag_mapping = R"([channels]
motor_angle = { table = "/joint_states", column = "position.shoulder", unit = "rad" }
motor_torque = { table = "/joint_states", column = "effort.shoulder", unit = "N m" }
load_angle = { table = "/joint_states", column = "position.elbow", unit = "rad" }
load_torque = { table = "/joint_states", column = "effort.elbow", unit = "N m" }
[recording]
mode = "lumped_drive"
)";

/// Runs `work` in a process of its own and prints how long it took and the most memory that it had.
template <typename Work>
void measure(const std::string& what, const Work& work) {
    std::cout << what << ": " << std::flush;
    const auto begin = std::chrono::steady_clock::now();
    const pid_t child = fork();
    if (child == 0) _exit(work());
    int status = 0;
    rusage usage{};
    wait4(child, &status, 0, &usage);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    const auto processor = [](const timeval& time) {
        return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
    };
    std::cout << seconds << " s (" << processor(usage.ru_utime) + processor(usage.ru_stime)
              << " s of a processor), " << static_cast<double>(usage.ru_maxrss) / 1024.0 << " MiB"
              << (status == 0 ? "" : ", FAILED") << std::endl;
}

void measure_log(const std::filesystem::path& log, const char* mapping, const std::string& program) {
    const std::string size = std::to_string(std::filesystem::file_size(log) / 1000000) + " MB";
    measure("reading " + size + " of " + log.extension().string(), [&] {
        const capstan::logs::Log read = capstan::logs::read_log(log);
        std::cout << read.tables.at(0).rows << " rows of " << read.tables[0].columns.size() << " columns, "
                  << std::flush;
        return read.remarks.empty() ? 0 : 1;
    });
    if (program.empty()) return;
    const std::filesystem::path toml = log.parent_path() / "log.toml",
                                recording = log.parent_path() / "recording";
    std::ofstream(toml) << mapping;
    measure("capstan import of it", [&] {
        std::freopen("/dev/null", "w", stdout);
        execl(program.c_str(), "capstan", "import", log.c_str(), "--mapping", toml.c_str(), "--progress",
              "none", "-o", recording.c_str(), nullptr);
        return 1;
    });
    for (const char* ending : {".csv", ".json"}) std::filesystem::remove(recording.string() + ending);
    std::filesystem::remove(toml);
}

}  // namespace

int main(int count, char** words) {
    if (count < 2) {
        std::cerr << "read_logs FOLDER [MEGABYTES [CAPSTAN]]\n";
        return 2;
    }
    const std::filesystem::path folder = words[1];
    const std::size_t bytes = (count > 2 ? std::strtoul(words[2], nullptr, 10) : 1000) * 1000000;
    const std::string program = count > 3 ? words[3] : "";
    write_text(folder / "log.csv", bytes);
    measure_log(folder / "log.csv", text_mapping, program);
    std::filesystem::remove(folder / "log.csv");
    write_bag(folder / "log.bag", bytes);
    measure_log(folder / "log.bag", bag_mapping, program);
    std::filesystem::remove(folder / "log.bag");
    return 0;
}
