#include "capstan/logs/isolated.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <fstream>
#include <stdexcept>

#include "capstan/cable/invalid_input.h"
#include "capstan/logs/byte_cursor.h"
#include "capstan/logs/table_writer.h"

namespace capstan::logs {

namespace {

constexpr rlim_t longest_reading_s = 300;                 // of processor time
constexpr rlim_t largest_memory_bytes = rlim_t{4} << 30;  // beyond what this program has already

// What the reading process sends: a letter, a length of 64 bits, and so many bytes.
enum Letter : char {
    table_letter = 'T',
    column_letter = 'C',
    numbers_letter = 'N',
    rows_letter = 'R',
    remark_letter = 'M',
    assumption_letter = 'A',
    format_letter = 'F',
    refusal_letter = 'X',
    progress_letter = 'P',
    end_letter = 'E'
};
constexpr std::size_t longest_piece = 1u << 20;

void send_bytes(int to, const char* bytes, std::size_t count) {
    while (count > 0) {
        const ssize_t sent = ::write(to, bytes, count);
        if (sent < 0 && errno == EINTR) continue;
        if (sent <= 0) _exit(1);  // nobody listens any more
        bytes += sent;
        count -= static_cast<std::size_t>(sent);
    }
}

void send(int to, Letter letter, std::string_view piece) {
    std::array<char, 9> head{letter};
    const std::uint64_t length = std::min(piece.size(), longest_piece);
    std::memcpy(head.data() + 1, &length, sizeof length);
    send_bytes(to, head.data(), head.size());
    send_bytes(to, piece.data(), length);
}

template <typename Number>
std::string_view bytes_of_number(const Number& number) {
    return {reinterpret_cast<const char*>(&number), sizeof number};
}

void send_log(int to, const Log& log) {
    send(to, format_letter, log.format);
    for (const LogTable& table : log.tables) {
        send(to, table_letter, table.name);
        for (const LogColumn& column : table.columns) {
            send(to, column_letter, column.name + std::string(1, '\0') + column.unit);
            NumberReader reader(column.values);
            for (auto block = reader.next_block(); !block.empty(); block = reader.next_block())
                send(to, numbers_letter, {reinterpret_cast<const char*>(block.data()), block.size_bytes()});
        }
        send(to, rows_letter, bytes_of_number(static_cast<std::uint64_t>(table.rows)));
    }
    for (const std::string& remark : log.remarks) send(to, remark_letter, remark);
    for (const std::string& assumption : log.assumptions) send(to, assumption_letter, assumption);
    send(to, end_letter, "");
}

// Sanitizers reserve terabytes, and cannot be limited so.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool can_limit_memory = false;
#elif defined(__has_feature)
constexpr bool can_limit_memory = !__has_feature(address_sanitizer) && !__has_feature(thread_sanitizer);
#else
constexpr bool can_limit_memory = true;
#endif

void limit_memory() {
    rlim_t pages = 0;  // addresses that are in use, most of them by the threads of the program
    std::ifstream("/proc/self/statm") >> pages;
    const rlim_t bytes = pages * static_cast<rlim_t>(::sysconf(_SC_PAGESIZE)) + largest_memory_bytes;
    const rlimit memory{bytes, bytes};
    if (can_limit_memory && pages > 0) ::setrlimit(RLIMIT_AS, &memory);
}

[[noreturn]] void read_and_send(int to, Log& log, ReadOptions options,
                                const std::function<void(const ReadOptions&, Log&)>& read) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    for (const int signal :
         {SIGSEGV, SIGABRT, SIGBUS, SIGFPE, SIGILL, SIGINT, SIGTERM, SIGALRM, SIGXCPU, SIGPIPE})
        ::signal(signal, SIG_DFL);
    const int nothing = ::open("/dev/null", O_WRONLY);
    ::dup2(nothing, STDOUT_FILENO);
    ::dup2(nothing, STDERR_FILENO);
    const rlimit time{longest_reading_s, longest_reading_s};
    ::setrlimit(RLIMIT_CPU, &time);
    const rlimit no_core{0, 0};
    ::setrlimit(RLIMIT_CORE, &no_core);
    limit_memory();
    if (options.on_progress)
        options.on_progress = [to](double fraction) { send(to, progress_letter, bytes_of_number(fraction)); };
    try {
        read(options, log);
        send_log(to, log);
    } catch (const std::exception& refusal) {
        send(to, refusal_letter, refusal.what());
    }
    _exit(0);
}

/// The other end: builds the log of what arrives.
class Receiver {
  public:
    Receiver(int from, Log& log, const ReadOptions& options)
        : from_(from),
          log_(log),
          everything_{{}, {}, {}, options.memory_limit_bytes},
          writer_(log, everything_),
          on_progress_(options.on_progress) {}

    /// True if all came.
    bool receive() {
        std::array<char, 9> head;
        while (take(head.data(), head.size())) {
            ByteCursor cursor({head.data() + 1, 8});
            piece_.resize(std::min<std::uint64_t>(cursor.number<std::uint64_t>(), longest_piece));
            if (!take(piece_.data(), piece_.size())) return false;
            if (head[0] == end_letter) return true;
            put(head[0]);
        }
        return false;
    }

  private:
    bool take(char* to, std::size_t count) {
        while (count > 0) {
            const ssize_t got = ::read(from_, to, count);
            if (got < 0 && errno == EINTR) continue;
            if (got <= 0) return false;
            to += got;
            count -= static_cast<std::size_t>(got);
        }
        return true;
    }

    void put(char letter) {
        ByteCursor cursor(piece_);
        switch (letter) {
            case format_letter:
                log_.format = piece_;
                break;
            case table_letter:
                table_ = writer_.add_table(piece_);
                break;
            case column_letter: {
                const std::size_t end = piece_.find('\0');
                if (table_ < 0 || end == std::string::npos) break;
                column_ = writer_.add_column(table_, piece_.substr(0, end), piece_.substr(end + 1));
                break;
            }
            case numbers_letter:
                numbers_.resize(piece_.size() / sizeof(double));
                std::memcpy(numbers_.data(), piece_.data(), numbers_.size() * sizeof(double));
                if (column_ >= 0) writer_.fill_column(table_, column_, numbers_);
                break;
            case rows_letter:
                if (table_ >= 0) writer_.set_rows(table_, cursor.number<std::uint64_t>());
                break;
            case assumption_letter:
                writer_.assume(piece_);
                break;
            case remark_letter:
                log_.remarks.push_back(piece_);
                break;
            case refusal_letter:
                throw InvalidInput(std::vector<std::string>{piece_});
            case progress_letter:
                if (on_progress_) on_progress_(cursor.number<double>());
                break;
            default:
                break;
        }
    }

    int from_;
    Log& log_;
    ReadOptions everything_;  ///< what is wanted was chosen on the other side
    TableWriter writer_;
    std::function<void(double)> on_progress_;
    int table_ = -1;
    int column_ = -1;
    std::string piece_;
    std::vector<double> numbers_;
};

/// Ends the process, and waits for it, however this one goes on.
struct ReadingProcess {
    pid_t id = -1;
    int from = -1;
    int status = 0;

    ~ReadingProcess() { end(); }
    void end() {
        if (from >= 0) ::close(from);
        from = -1;
        if (id > 0) {
            ::kill(id, SIGKILL);
            while (::waitpid(id, &status, 0) < 0 && errno == EINTR) continue;
        }
        id = -1;
    }
};

}  // namespace

void read_isolated(Log& log, const ReadOptions& options,
                   const std::function<void(const ReadOptions& options, Log& log)>& read) {
    std::array<int, 2> ends{};
    if (::pipe2(ends.data(), O_CLOEXEC) != 0)
        throw std::runtime_error(fmt::format("cannot make a pipe: {}", std::strerror(errno)));
    ReadingProcess process;
    process.from = ends[0];
    process.id = ::fork();
    if (process.id == 0) read_and_send(ends[1], log, options, read);
    ::close(ends[1]);
    if (process.id < 0)
        throw std::runtime_error(fmt::format("cannot start a process: {}", std::strerror(errno)));
    if (Receiver(process.from, log, options).receive()) return;
    throw InvalidInput(
        {fmt::format("{}: the library that reads {} files failed on it; the file is damaged, or needs "
                     "more than {} GB of memory. Save it again, or as CSV",
                     log.file.string(), log.format, largest_memory_bytes >> 30)});
}

}  // namespace capstan::logs
