#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <chrono>
#include <fstream>
#include <stdexcept>
#include <thread>

#include "capstan/platform/files.h"
#include "capstan/units/shared_folder.h"

namespace capstan::units {

namespace fs = std::filesystem;

namespace {

std::optional<double> modification_time_s(const fs::path& file) {
    struct stat status {};
    if (::stat(file.c_str(), &status) != 0) return std::nullopt;
    return static_cast<double>(status.st_mtim.tv_sec) + 1e-9 * static_cast<double>(status.st_mtim.tv_nsec);
}

class DiskHeart final : public SharedFolder::Heart {
  public:
    explicit DiskHeart(fs::path file)
        : thread_([path = std::move(file), this] {
              constexpr int beat_every = 50;  // tenths of a second
              for (int tenths = 1; !ends_.load(); ++tenths) {
                  std::this_thread::sleep_for(std::chrono::milliseconds(100));
                  if (tenths % beat_every == 0) ::utimensat(AT_FDCWD, path.c_str(), nullptr, 0);
              }
          }) {}
    ~DiskHeart() override {
        ends_.store(true);
        thread_.join();
    }

  private:
    std::atomic<bool> ends_{false};
    std::thread thread_;
};

}  // namespace

std::string DiskFolder::worker() const {
    std::array<char, 256> host{};
    if (::gethostname(host.data(), host.size() - 1) != 0) host[0] = '\0';
    return std::string(host.data()) + "-" + std::to_string(::getpid());
}

double DiskFolder::now_s() {
    const fs::path probe = folder_ / (".clock-" + worker());
    std::ofstream(probe) << "now\n";
    const auto time_s = modification_time_s(probe);
    std::error_code none;
    fs::remove(probe, none);
    if (time_s) return *time_s;
    return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

void DiskFolder::pause(double seconds) {
    std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
}

bool DiskFolder::create(const std::string& name, const std::string& text) {
    const fs::path file = folder_ / name;
    const int descriptor = ::open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor < 0) {
        if (errno == EEXIST) return false;
        throw std::runtime_error("cannot write " + file.string() + ": " +
                                 std::generic_category().message(errno));
    }
    const bool is_written =
        ::write(descriptor, text.data(), text.size()) == static_cast<ssize_t>(text.size());
    ::close(descriptor);
    if (!is_written) throw std::runtime_error("cannot write " + file.string() + "; is the disk full?");
    return true;
}

void DiskFolder::replace(const std::string& name, const std::string& text) {
    write_file(folder_ / name, text);
}

std::optional<std::string> DiskFolder::read(const std::string& name) {
    std::error_code none;
    if (!fs::exists(folder_ / name, none)) return std::nullopt;
    std::ifstream stream(folder_ / name, std::ios::binary);
    if (!stream) return std::nullopt;  // removed since
    return std::string(std::istreambuf_iterator<char>(stream), {});
}

std::optional<double> DiskFolder::modified_s(const std::string& name) {
    return modification_time_s(folder_ / name);
}

std::vector<std::string> DiskFolder::names() {
    std::vector<std::string> names;
    std::error_code none;
    for (const auto& entry : fs::directory_iterator(folder_, none))
        names.push_back(entry.path().filename().string());
    return names;
}

bool DiskFolder::rename(const std::string& from, const std::string& to) {
    std::error_code none;
    fs::rename(folder_ / from, folder_ / to, none);
    return !none;
}

bool DiskFolder::link(const std::string& from, const std::string& to) {
    std::error_code none;
    fs::create_hard_link(folder_ / from, folder_ / to, none);
    return !none;
}

bool DiskFolder::remove(const std::string& name) noexcept {
    std::error_code none;
    return fs::remove(folder_ / name, none);
}

std::unique_ptr<SharedFolder::Heart> DiskFolder::beat(const std::string& name) {
    return std::make_unique<DiskHeart>(folder_ / name);
}

}  // namespace capstan::units
