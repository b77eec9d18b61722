// MATLAB files of versions 4, 5 to 7 and 7.3, read by libmatio.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <matio.h>

#include <algorithm>
#include <cstring>
#include <map>
#include <memory>

#include "capstan/cable/invalid_input.h"
#include "capstan/logs/byte_source.h"
#include "capstan/logs/isolated.h"
#include "capstan/logs/matlab_objects.h"
#include "capstan/logs/text_lines.h"
#include "capstan/logs/vector_groups.h"

namespace capstan::logs {

namespace {

constexpr std::size_t mat5_head_bytes = 128;
constexpr std::size_t mat4_head_bytes = 20;
constexpr std::size_t largest_variable_bytes = 1u << 30;  // libmatio reads a variable at once
constexpr std::uint64_t largest_packing = 1100;           // zlib packs at most so many times
constexpr std::size_t longest_unit_letters = 64;
constexpr int deepest_struct = 16;
constexpr std::size_t max_struct_elements = 1024;

struct CloseMat {
    void operator()(mat_t* file) const { Mat_Close(file); }
};
struct FreeVariable {
    void operator()(matvar_t* variable) const { Mat_VarFree(variable); }
};
using Variable = std::unique_ptr<matvar_t, FreeVariable>;

std::uint32_t swapped(std::uint32_t number, bool is_big_endian) {
    return is_big_endian ? __builtin_bswap32(number) : number;
}

/// The head of a variable of version 4.
struct Mat4Head {
    std::uint32_t type, rows, columns, is_complex, name_bytes;

    bool is_good() const {
        return type < 5000 && type % 1000 < 60 && type / 100 % 10 == 0 && type % 10 <= 2 && is_complex <= 1 &&
               name_bytes >= 1 && name_bytes <= 64;
    }
    std::uint64_t bytes() const {
        constexpr std::uint64_t sizes[6] = {8, 4, 4, 2, 2, 1};
        return name_bytes + sizes[type / 10 % 10] * rows * columns * (1 + is_complex);
    }
};

std::optional<Mat4Head> mat4_head(std::string_view bytes) {
    if (bytes.size() < mat4_head_bytes) return std::nullopt;
    for (const bool is_big_endian : {false, true}) {
        std::uint32_t words[5];
        std::memcpy(words, bytes.data(), sizeof words);
        for (std::uint32_t& word : words) word = swapped(word, is_big_endian);
        const Mat4Head head{words[0], words[1], words[2], words[3], words[4]};
        // The thousands of the type say which order of bytes it is.
        if (head.is_good() && (head.type / 1000 == 1) == is_big_endian && head.rows < 1u << 30 &&
            head.columns < 1u << 30)
            return head;
    }
    return std::nullopt;
}

/// How many variables are complete, and whether something follows them; libmatio itself reads on in the dark.
struct CompleteVariables {
    std::size_t count = 0;
    bool is_cut = false;
};

CompleteVariables complete_variables(const std::filesystem::path& path, bool is_version_4) {
    FileSource file(path);
    CompleteVariables complete;
    bool is_big_endian = false;
    if (!is_version_4) {
        std::string head(mat5_head_bytes, '\0');
        complete.is_cut = file.read(head.data(), head.size()) < head.size();
        is_big_endian = head.ends_with("MI");
    }
    while (!complete.is_cut && file.position() < file.size_bytes()) {
        std::string head(is_version_4 ? mat4_head_bytes : 8, '\0');
        const bool is_short = file.read(head.data(), head.size()) < head.size();
        std::uint64_t bytes = 0;
        if (is_version_4) {
            const auto of_version_4 = mat4_head(head);
            complete.is_cut = is_short || !of_version_4;
            if (!complete.is_cut) bytes = of_version_4->bytes();
        } else {
            std::uint32_t words[2];
            std::memcpy(words, head.data(), sizeof words);
            complete.is_cut = is_short;
            bytes = swapped(words[1], is_big_endian);
        }
        complete.is_cut = complete.is_cut || bytes > file.size_bytes() - file.position();
        if (complete.is_cut) break;
        ++complete.count;
        file.seek(file.position() + bytes);
    }
    return complete;
}

class MatReading {
  public:
    MatReading(const ReadOptions& options, Log& log) : writer_(log, options), path_(log.file) {}

    void read() {
        const std::unique_ptr<mat_t, CloseMat> file(Mat_Open(path_.c_str(), MAT_ACC_RDONLY));
        if (!file)
            throw InvalidInput(
                {fmt::format("{}: is cut or damaged, so that libmatio cannot open it", path_.string())});
        file_ = file.get();
        file_bytes_ = std::filesystem::file_size(path_);
        const mat_ft version = Mat_GetVersion(file_);
        writer_.log().format = version == MAT_FT_MAT73  ? "MATLAB 7.3"
                               : version == MAT_FT_MAT4 ? "MATLAB 4"
                                                        : "MATLAB 5";
        CompleteVariables complete{SIZE_MAX, false};
        if (version != MAT_FT_MAT73) complete = complete_variables(path_, version == MAT_FT_MAT4);
        std::vector<Variable> variables;  // the matrices point into them
        while (variables.size() < std::min(complete.count, LogLimits::columns)) {
            Variable variable(Mat_VarReadNextInfo(file_));
            if (!variable) break;
            if (variable->name) collect(variable.get(), "", variable->name, 0);
            variables.push_back(std::move(variable));
        }
        if (variables.empty())
            throw InvalidInput({fmt::format(
                "{}: has no complete variable; {}", path_.string(),
                complete.is_cut ? "the file is cut in the first one" : "it is empty, cut or damaged")});
        if (!complete.is_cut && complete.count != SIZE_MAX && variables.size() < complete.count)
            writer_.remark(fmt::format("{} of {} variables can be read; the file is damaged",
                                       variables.size(), complete.count));
        if (version == MAT_FT_MAT5)
            for (std::string& object : matlab_objects(path_)) leave_out(std::move(object));
        read_units();
        write_groups(matrices_, writer_);
        if (complete.is_cut)
            writer_.remark(
                fmt::format("The file is cut; the {} variables before that are read", complete.count));
        if (!left_out_.empty())
            writer_.remark(fmt::format("Left out, as {} no matrix of real numbers: {}",
                                       left_out_.size() == 1 ? "it is" : "they are",
                                       fmt::join(left_out_, ", ")));
        if (std::any_of(left_out_.begin(), left_out_.end(),
                        [](const std::string& what) { return what.find("(an object") != what.npos; }))
            writer_.remark(
                "Objects such as timeseries and timetable cannot be read: in MATLAB, save their numbers, for "
                "example log.t = ts.Time; log.x = ts.Data; save('log.mat', 'log')");
    }

  private:
    // `home`: the variable it is in, empty for one of its own; `name`: its name in there.
    void collect(matvar_t* variable, const std::string& home, const std::string& name, int depth) {
        if (variable->class_type == MAT_C_STRUCT) return collect_struct(variable, home, name, depth);
        const std::string path = as_utf8(home.empty() ? name : home + "." + name);
        const bool is_numeric =
            (variable->class_type >= MAT_C_DOUBLE && variable->class_type <= MAT_C_UINT64);
        if (!is_numeric || variable->isComplex || variable->rank != 2 || !variable->dims) {
            leave_out(fmt::format("{} ({})", path, kind(*variable)));
            return;
        }
        const std::size_t rows = variable->dims[0], columns = variable->dims[1];
        if (rows == 0 || columns == 0) return;
        const std::size_t size = Mat_SizeOfClass(variable->class_type);
        if (rows > largest_variable_bytes || columns > largest_variable_bytes ||
            rows * columns * size > largest_variable_bytes ||
            rows * columns * size > largest_packing * file_bytes_) {
            leave_out(fmt::format("{} (it claims {} x {} numbers, more than the file can hold or than {} MB)",
                                  path, rows, columns, largest_variable_bytes >> 20));
            return;
        }
        matrices_.push_back({home, name, "", rows, columns, false,
                             [this, variable](const auto& take) { read_numbers(variable, take); }});
    }

    void collect_struct(matvar_t* variable, const std::string& home, const std::string& name, int depth) {
        const std::size_t fields =
            variable->rank > 0 && variable->data ? Mat_VarGetNumberOfFields(variable) : 0;
        std::size_t elements = 1;
        for (int k = 0; k < variable->rank; ++k)
            elements *= std::min<std::size_t>(variable->dims[k], max_struct_elements + 1);
        if (depth == deepest_struct || elements > max_struct_elements || fields > LogLimits::columns) {
            leave_out(fmt::format("{} (a struct that is nested too deeply or too large)", as_utf8(name)));
            return;
        }
        char* const* names = fields > 0 ? Mat_VarGetStructFieldnames(variable) : nullptr;
        if (!names) return;
        for (std::size_t element = 0; element < elements; ++element) {
            if (home.empty() && elements == 1) find_units(variable, name);
            const std::string own = elements == 1 ? name : fmt::format("{}({})", name, element + 1);
            for (std::size_t field = 0; field < fields; ++field) {
                matvar_t* inner = Mat_VarGetStructFieldByIndex(variable, field, element);
                if (!inner || !names[field]) continue;
                if (home.empty() && elements == 1 && names[field] == std::string_view("units") &&
                    inner->class_type == MAT_C_STRUCT)
                    continue;
                if (home.empty())
                    collect(inner, own, names[field], depth + 1);
                else
                    collect(inner, home, own + "." + names[field], depth + 1);
            }
        }
    }

    // A struct `units` beside the vectors has their units as texts, by their names. They are read when all
    // variables are known: libmatio looks for the next one where it read last.
    void find_units(matvar_t* variable, const std::string& name) {
        matvar_t* units = Mat_VarGetStructFieldByName(variable, "units", 0);
        if (!units || units->class_type != MAT_C_STRUCT || units->rank != 2 || !units->data ||
            units->dims[0] != 1 || units->dims[1] != 1)
            return;
        const std::size_t fields = std::min<std::size_t>(Mat_VarGetNumberOfFields(units), LogLimits::columns);
        char* const* names = fields > 0 ? Mat_VarGetStructFieldnames(units) : nullptr;
        for (std::size_t field = 0; names && field < fields; ++field) {
            matvar_t* text = Mat_VarGetStructFieldByIndex(units, field, 0);
            if (text && names[field] && text->class_type == MAT_C_CHAR && text->rank == 2 && text->dims &&
                text->dims[0] == 1 && text->dims[1] <= longest_unit_letters)
                units_[name + "." + names[field]] = text;
        }
    }

    void read_units() {
        for (NamedMatrix& matrix : matrices_) {
            const auto found = units_.find(matrix.home + "." + matrix.name);
            if (found == units_.end()) continue;
            matvar_t* text = found->second;
            if (Mat_VarReadDataAll(file_, text) != 0 || !text->data) continue;
            const auto* bytes = static_cast<const char*>(text->data);
            const auto wide = static_cast<std::size_t>(std::max(text->data_size, 1));
            for (std::size_t k = 0; k + wide <= text->nbytes && matrix.unit.size() < longest_unit_letters;
                 k += wide)
                matrix.unit += bytes[k];
        }
    }

    static const char* kind(const matvar_t& variable) {
        if (variable.class_type == MAT_C_CELL) return "a cell array";
        if (variable.class_type == MAT_C_CHAR) return "text";
        if (variable.class_type == MAT_C_SPARSE) return "a sparse matrix";
        if (variable.isComplex) return "complex";
        if (variable.rank != 2) return "more than two dimensions";
        return "an object";
    }

    void leave_out(std::string what) {
        constexpr std::size_t named = 20;
        if (left_out_.size() < named)
            left_out_.push_back(std::move(what));
        else if (left_out_.size() == named)
            left_out_.emplace_back("and others");
    }

    template <typename Number>
    static void hand_over(const matvar_t& variable, std::size_t count,
                          const std::function<void(std::span<const double>)>& take) {
        const auto* numbers = static_cast<const Number*>(variable.data);
        std::vector<double> block;
        for (std::size_t at = 0; at < count; at += block.size()) {
            block.assign(numbers + at, numbers + std::min(count, at + NumberStore::block_numbers));
            take(block);
        }
    }

    void read_numbers(matvar_t* variable, const std::function<void(std::span<const double>)>& take) {
        if (Mat_VarReadDataAll(file_, variable) != 0 || !variable->data) return;
        const std::size_t size = Mat_SizeOfClass(variable->class_type);
        const std::size_t count = std::min(variable->dims[0] * variable->dims[1], variable->nbytes / size);
        switch (variable->class_type) {
            case MAT_C_DOUBLE:
                hand_over<double>(*variable, count, take);
                break;
            case MAT_C_SINGLE:
                hand_over<float>(*variable, count, take);
                break;
            case MAT_C_INT8:
                hand_over<std::int8_t>(*variable, count, take);
                break;
            case MAT_C_UINT8:
                hand_over<std::uint8_t>(*variable, count, take);
                break;
            case MAT_C_INT16:
                hand_over<std::int16_t>(*variable, count, take);
                break;
            case MAT_C_UINT16:
                hand_over<std::uint16_t>(*variable, count, take);
                break;
            case MAT_C_INT32:
                hand_over<std::int32_t>(*variable, count, take);
                break;
            case MAT_C_UINT32:
                hand_over<std::uint32_t>(*variable, count, take);
                break;
            case MAT_C_INT64:
                hand_over<std::int64_t>(*variable, count, take);
                break;
            case MAT_C_UINT64:
                hand_over<std::uint64_t>(*variable, count, take);
                break;
            default:
                break;
        }
        std::free(variable->data);
        variable->data = nullptr;
    }

    TableWriter writer_;
    std::filesystem::path path_;
    mat_t* file_ = nullptr;
    std::uint64_t file_bytes_ = 0;
    std::map<std::string, matvar_t*> units_;  // by variable.field
    std::vector<NamedMatrix> matrices_;
    std::vector<std::string> left_out_;
};

bool is_mat(std::string_view head, const std::filesystem::path&) {
    if (head.starts_with("MATLAB 5.0 MAT-file") || head.starts_with("MATLAB 7.3 MAT-file")) return true;
    const auto version_4 = mat4_head(head);
    // A version 4 file has no signature: its first variable must have a name as MATLAB allows it.
    if (!version_4 || head.size() < mat4_head_bytes + version_4->name_bytes) return false;
    const std::string_view name = head.substr(mat4_head_bytes, version_4->name_bytes);
    return name.back() == '\0' && name.size() > 1 &&
           std::all_of(name.begin(), name.end() - 1, [](char letter) {
               return (letter >= 'a' && letter <= 'z') || (letter >= 'A' && letter <= 'Z') || letter == '_' ||
                      (letter >= '0' && letter <= '9');
           });
}

void read_mat(const std::filesystem::path&, const ReadOptions& options, Log& log) {
    read_isolated(log, options, [](const ReadOptions& own, Log& inner) { MatReading(own, inner).read(); });
}

}  // namespace

const LogFormat matlab_format{"MATLAB", ".mat of versions 4 to 7.3", is_mat, read_mat};

}  // namespace capstan::logs
