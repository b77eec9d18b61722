// HDF5 files, read by libhdf5.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <hdf5.h>

#include <algorithm>
#include <memory>
#include <set>

#include "capstan/cable/invalid_input.h"
#include "capstan/logs/isolated.h"
#include "capstan/logs/text_lines.h"
#include "capstan/logs/vector_groups.h"

namespace capstan::logs {

namespace {

constexpr int deepest_group = 32;
constexpr std::size_t max_datasets = 4096;
constexpr hsize_t hdf5_block_rows = 8192;
constexpr std::uint64_t largest_hdf5_packing = 1100;
constexpr std::size_t longest_unit_bytes = 256;

/// Closes what libhdf5 opened.
class Handle {
  public:
    Handle(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
    ~Handle() {
        if (id_ >= 0) close_(id_);
    }
    Handle(const Handle&) = delete;
    Handle& operator=(const Handle&) = delete;

    hid_t id() const { return id_; }
    bool is_good() const { return id_ >= 0; }

  private:
    hid_t id_;
    herr_t (*close_)(hid_t);
};

bool is_number(hid_t type) {
    const H5T_class_t kind = H5Tget_class(type);
    if (kind == H5T_ENUM) {  // h5py's booleans
        const Handle base(H5Tget_super(type), H5Tclose);
        return base.is_good() && H5Tget_class(base.id()) == H5T_INTEGER;
    }
    return kind == H5T_INTEGER || kind == H5T_FLOAT;
}

std::string unit_of(hid_t dataset) {
    for (const char* name : {"unit", "units"}) {
        if (H5Aexists(dataset, name) <= 0) continue;
        const Handle attribute(H5Aopen(dataset, name, H5P_DEFAULT), H5Aclose);
        const Handle type(H5Aget_type(attribute.id()), H5Tclose);
        const Handle space(H5Aget_space(attribute.id()), H5Sclose);
        if (H5Tget_class(type.id()) != H5T_STRING || H5Sget_simple_extent_npoints(space.id()) != 1) continue;
        if (H5Tis_variable_str(type.id()) > 0) {
            char* text = nullptr;
            const Handle memory(H5Tcopy(H5T_C_S1), H5Tclose);
            H5Tset_size(memory.id(), H5T_VARIABLE);
            H5Tset_cset(memory.id(), H5Tget_cset(type.id()));
            if (H5Aread(attribute.id(), memory.id(), &text) < 0 || !text) continue;
            std::string unit(text, strnlen(text, longest_unit_bytes));
            H5free_memory(text);
            return unit;
        }
        std::string unit(std::min<std::size_t>(H5Tget_size(type.id()), longest_unit_bytes), '\0');
        if (H5Tget_size(type.id()) > longest_unit_bytes ||
            H5Aread(attribute.id(), type.id(), unit.data()) < 0)
            continue;
        return unit.substr(0, unit.find('\0'));
    }
    return "";
}

class Hdf5Reading {
  public:
    Hdf5Reading(const ReadOptions& options, Log& log)
        : options_(options), writer_(log, options), path_(log.file) {}

    void read() {
        H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
        H5PLset_loading_state(0);  // no filter comes from a file's author
        const Handle file(H5Fopen(path_.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
        if (!file.is_good())
            throw InvalidInput(
                {fmt::format("{}: is cut or damaged, so that libhdf5 cannot open it; copy the file again, or "
                             "close the program that writes it",
                             path_.string())});
        file_bytes_ = std::filesystem::file_size(path_);
        collect_group(file.id(), "", 0);
        write_groups(matrices_, writer_);
        for (const CompoundTable& table : compounds_) read_compound(table);
        if (!left_out_.empty())
            writer_.remark(fmt::format("Left out, as {} no vector, matrix or table of real numbers: {}",
                                       left_out_.size() == 1 ? "it is" : "they are",
                                       fmt::join(left_out_, ", ")));
    }

  private:
    struct CompoundTable {
        std::string name;
        std::shared_ptr<Handle> dataset;
        hsize_t rows;
    };

    void collect_group(hid_t group, const std::string& path, int depth) {
        H5G_info_t info{};
        if (depth > deepest_group || H5Gget_info(group, &info) < 0) return leave_out(path, "cannot be read");
        for (hsize_t k = 0; k < std::min<hsize_t>(info.nlinks, max_datasets); ++k) {
            char name[LogLimits::name_bytes];
            const ssize_t length =
                H5Lget_name_by_idx(group, ".", H5_INDEX_NAME, H5_ITER_INC, k, name, sizeof name, H5P_DEFAULT);
            if (length <= 0 || static_cast<std::size_t>(length) >= sizeof name) continue;
            const std::string own = path.empty() ? name : path + "/" + name;
            H5L_info_t link{};
            if (H5Lget_info(group, name, &link, H5P_DEFAULT) < 0) continue;
            // A link to another file is not followed, nor one to a place that has its own name.
            if (link.type != H5L_TYPE_HARD) {
                leave_out(own, "a link");
                continue;
            }
            H5O_info_t object{};
            if (H5Oget_info_by_name(group, name, &object, H5P_DEFAULT) < 0) {
                leave_out(own, "damaged");
                continue;
            }
            if (!seen_.insert(object.addr).second || seen_.size() > max_datasets) continue;
            if (object.type == H5O_TYPE_GROUP) {
                const Handle inner(H5Gopen2(group, name, H5P_DEFAULT), H5Gclose);
                if (inner.is_good()) collect_group(inner.id(), own, depth + 1);
            } else if (object.type == H5O_TYPE_DATASET) {
                collect_dataset(std::make_shared<Handle>(H5Dopen2(group, name, H5P_DEFAULT), H5Dclose), path,
                                name, own);
            }
        }
    }

    void collect_dataset(const std::shared_ptr<Handle>& dataset, const std::string& home,
                         const std::string& name, const std::string& path) {
        if (!dataset->is_good()) return leave_out(path, "damaged");
        const Handle type(H5Dget_type(dataset->id()), H5Tclose);
        const Handle space(H5Dget_space(dataset->id()), H5Sclose);
        const int rank = H5Sget_simple_extent_ndims(space.id());
        hsize_t dims[2] = {1, 1};
        if (rank < 0 || rank > 2) return leave_out(path, "more than two dimensions");
        if (rank > 0) H5Sget_simple_extent_dims(space.id(), dims, nullptr);
        if (dims[0] == 0 || dims[1] == 0) return;
        const char* refusal = refusal_of(dataset->id(), type.id(), dims[0], dims[1]);
        if (refusal) return leave_out(path, refusal);
        if (H5Tget_class(type.id()) == H5T_COMPOUND && dims[1] == 1) {
            compounds_.push_back({path, dataset, dims[0]});
        } else if (is_number(type.id())) {
            matrices_.push_back({home, name, unit_of(dataset->id()), dims[0], dims[1], true,
                                 [this, dataset, rows = dims[0], columns = dims[1], rank](const auto& take) {
                                     read_matrix(dataset->id(), rank, rows, columns, take);
                                 }});
        } else {
            leave_out(path, H5Tget_class(type.id()) == H5T_STRING ? "text" : "of another type");
        }
    }

    // Null if the sizes can be true and the numbers are in this file.
    const char* refusal_of(hid_t dataset, hid_t type, hsize_t rows, hsize_t columns) const {
        const Handle created(H5Dget_create_plist(dataset), H5Pclose);
        const H5D_layout_t layout = H5Pget_layout(created.id());
        if (layout == H5D_VIRTUAL || H5Pget_external_count(created.id()) > 0) return "in another file";
        const std::uint64_t size = H5Tget_size(type);
        if (size == 0 || size > LogLimits::chunk_bytes || rows > LogLimits::numbers ||
            columns > LogLimits::numbers || rows * columns > LogLimits::numbers ||
            rows * columns * size > largest_hdf5_packing * file_bytes_)
            return "it claims more numbers than the file can hold";
        if (layout != H5D_CHUNKED) return nullptr;
        hsize_t chunk[2] = {1, 1};
        if (H5Pget_chunk(created.id(), 2, chunk) < 0 || chunk[0] > LogLimits::chunk_bytes ||
            chunk[1] > LogLimits::chunk_bytes || chunk[0] * chunk[1] * size > LogLimits::chunk_bytes)
            return "its chunks are larger than the limit";
        return nullptr;
    }

    // Of a dataset from `begin` on, into memory of `type`; false if that fails.
    static bool read_rows(hid_t dataset, hid_t type, int rank, hsize_t begin, hsize_t rows, hsize_t columns,
                          void* to) {
        const Handle file_space(H5Dget_space(dataset), H5Sclose);
        const hsize_t start[2] = {begin, 0}, count[2] = {rows, columns};
        if (rank > 0 &&
            H5Sselect_hyperslab(file_space.id(), H5S_SELECT_SET, start, nullptr, count, nullptr) < 0)
            return false;
        const hsize_t all = rows * columns;
        const Handle memory_space(H5Screate_simple(1, &all, nullptr), H5Sclose);
        return H5Dread(dataset, type, memory_space.id(), file_space.id(), H5P_DEFAULT, to) >= 0;
    }

    void read_matrix(hid_t dataset, int rank, hsize_t rows, hsize_t columns,
                     const std::function<void(std::span<const double>)>& take) {
        const hsize_t block_rows =
            std::max<hsize_t>(1, 16 * hdf5_block_rows / std::max<hsize_t>(columns, 16));
        if (columns > LogLimits::chunk_bytes / sizeof(double)) return;
        std::vector<double> numbers;
        const Handle stored(H5Dget_type(dataset), H5Tclose);
        const bool is_enum = H5Tget_class(stored.id()) == H5T_ENUM;
        for (hsize_t begin = 0; begin < rows; begin += block_rows) {
            const hsize_t count = std::min(block_rows, rows - begin);
            numbers.resize(count * columns);
            if (is_enum) {
                std::vector<std::int8_t> truths(numbers.size());
                if (H5Tget_size(stored.id()) != 1 ||
                    !read_rows(dataset, stored.id(), rank, begin, count, columns, truths.data()))
                    return;
                std::copy(truths.begin(), truths.end(), numbers.begin());
            } else if (!read_rows(dataset, H5T_NATIVE_DOUBLE, rank, begin, count, columns, numbers.data())) {
                return;
            }
            take(numbers);
            if (options_.on_progress)
                options_.on_progress(static_cast<double>(begin + count) / static_cast<double>(rows));
        }
    }

    /// Numbers of one member of a compound: one, or an array of them.
    struct Member {
        std::string name;
        std::size_t count;
        std::vector<int> columns;
    };

    void read_compound(const CompoundTable& compound) {
        const Handle stored(H5Dget_type(compound.dataset->id()), H5Tclose);
        const int table = writer_.add_table(as_utf8(compound.name));
        std::vector<Member> members;
        const int count = std::min(H5Tget_nmembers(stored.id()), static_cast<int>(LogLimits::columns));
        std::size_t numbers_in_row = 0;
        std::vector<std::string> others;
        for (int k = 0; k < count; ++k) {
            char* raw_name = H5Tget_member_name(stored.id(), static_cast<unsigned>(k));
            if (!raw_name) continue;
            Member member{std::string(raw_name), 1, {}};
            H5free_memory(raw_name);
            const Handle type(H5Tget_member_type(stored.id(), static_cast<unsigned>(k)), H5Tclose);
            bool is_good = is_number(type.id());
            if (H5Tget_class(type.id()) == H5T_ARRAY && H5Tget_array_ndims(type.id()) == 1) {
                hsize_t length = 0;
                H5Tget_array_dims2(type.id(), &length);
                const Handle base(H5Tget_super(type.id()), H5Tclose);
                is_good = length > 0 && length <= LogLimits::columns && is_number(base.id());
                member.count = length;
            } else if (H5Tget_class(type.id()) == H5T_ENUM) {
                is_good = false;
            }
            if (!is_good) {
                others.push_back(as_utf8(member.name));
                continue;
            }
            const bool is_array = H5Tget_class(type.id()) == H5T_ARRAY;
            for (std::size_t element = 0; element < member.count; ++element)
                member.columns.push_back(writer_.add_column(
                    table, as_utf8(is_array ? fmt::format("{}.{}", member.name, element) : member.name)));
            numbers_in_row += member.count;
            members.push_back(std::move(member));
        }
        if (!others.empty())
            writer_.remark(fmt::format("{}: left out, as no number: {}", as_utf8(compound.name),
                                       fmt::join(others, ", ")));
        if (numbers_in_row > 0) read_members(compound, table, members, numbers_in_row);
    }

    void read_members(const CompoundTable& compound, int table, const std::vector<Member>& members,
                      std::size_t numbers_in_row) {
        // The same members as doubles, side by side; libhdf5 converts by their names.
        const Handle memory(H5Tcreate(H5T_COMPOUND, numbers_in_row * sizeof(double)), H5Tclose);
        std::size_t offset = 0;
        for (const Member& member : members) {
            const hsize_t length = member.count;
            const Handle stored(H5Dget_type(compound.dataset->id()), H5Tclose);
            const Handle array(H5Tarray_create2(H5T_NATIVE_DOUBLE, 1, &length), H5Tclose);
            const int index = H5Tget_member_index(stored.id(), member.name.c_str());
            const bool is_array =
                index >= 0 && H5Tget_member_class(stored.id(), static_cast<unsigned>(index)) == H5T_ARRAY;
            H5Tinsert(memory.id(), member.name.c_str(), offset, is_array ? array.id() : H5T_NATIVE_DOUBLE);
            offset += member.count * sizeof(double);
        }
        const hsize_t block_rows =
            std::max<hsize_t>(1, 16 * hdf5_block_rows / std::max<std::size_t>(numbers_in_row, 16));
        std::vector<double> numbers;
        for (hsize_t begin = 0; begin < compound.rows; begin += block_rows) {
            const hsize_t count = std::min(block_rows, compound.rows - begin);
            numbers.assign(count * numbers_in_row, 0.0);
            if (!read_rows(compound.dataset->id(), memory.id(), 1, begin, count, 1, numbers.data())) {
                writer_.remark(fmt::format("'{}' is damaged or cut: {} of its {} rows are read",
                                           as_utf8(compound.name), begin, compound.rows));
                return;
            }
            for (hsize_t row = 0; row < count; ++row) {
                const double* next = numbers.data() + row * numbers_in_row;
                for (const Member& member : members)
                    for (const int column : member.columns) {
                        const double number = *next++;
                        if (column >= 0) writer_.row(table)[static_cast<std::size_t>(column)] = number;
                    }
                writer_.finish_row(table);
            }
        }
    }

    void leave_out(const std::string& path, const char* why) {
        constexpr std::size_t named = 20;
        if (left_out_.size() < named)
            left_out_.push_back(fmt::format("{} ({})", as_utf8(path.empty() ? "/" : path), why));
        else if (left_out_.size() == named)
            left_out_.emplace_back("and others");
    }

    const ReadOptions& options_;
    TableWriter writer_;
    std::filesystem::path path_;
    std::uint64_t file_bytes_ = 0;
    std::set<haddr_t> seen_;
    std::vector<NamedMatrix> matrices_;
    std::vector<CompoundTable> compounds_;
    std::vector<std::string> left_out_;
};

bool is_hdf5(std::string_view head, const std::filesystem::path&) {
    constexpr std::string_view signature("\x89HDF\r\n\x1a\n");
    if (head.starts_with(signature)) return true;
    for (const std::size_t at : {512, 1024, 2048})  // behind a block of the user's own
        if (head.size() >= at + signature.size() && head.substr(at).starts_with(signature)) return true;
    return false;
}

void read_hdf5(const std::filesystem::path&, const ReadOptions& options, Log& log) {
    read_isolated(log, options, [](const ReadOptions& own, Log& inner) { Hdf5Reading(own, inner).read(); });
}

}  // namespace

const LogFormat hdf5_format{"HDF5", ".h5, .hdf5", is_hdf5, read_hdf5};

}  // namespace capstan::logs
