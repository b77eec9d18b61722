#include <fmt/format.h>
#include <matio.h>

#include <cctype>
#include <memory>
#include <set>
#include <stdexcept>

#include "capstan/export/series.h"
#include "capstan/platform/files.h"

namespace capstan::exports {

namespace {

constexpr std::size_t longest_matlab_name = 63;

struct CloseMatFile {
    void operator()(mat_t* file) const { Mat_Close(file); }
};
struct FreeMatVariable {
    void operator()(matvar_t* variable) const { Mat_VarFree(variable); }
};
using MatVariable = std::unique_ptr<matvar_t, FreeMatVariable>;

/// Names of variables or fields: letters, digits and underscores, at most 63, each once.
class MatlabNames {
  public:
    std::string operator()(const std::string& name) {
        std::string plain;
        for (const char letter : name)
            plain += std::isalnum(static_cast<unsigned char>(letter)) != 0 ? letter : '_';
        if (plain.empty() || std::isalpha(static_cast<unsigned char>(plain.front())) == 0)
            plain = "x" + plain;
        plain = plain.substr(0, longest_matlab_name);
        std::string unique = plain;
        for (int number = 2; !taken_.insert(unique).second; ++number) {
            const std::string ending = fmt::format("_{}", number);
            unique = plain.substr(0, longest_matlab_name - ending.size()) + ending;
        }
        return unique;
    }

  private:
    std::set<std::string> taken_;
};

matvar_t* made(matvar_t* variable) {
    if (variable == nullptr)
        throw std::runtime_error("libmatio cannot make a variable; is the memory used up?");
    return variable;
}

// libmatio copies what it is handed.
matvar_t* vector_variable(const std::vector<double>& values) {
    std::size_t size[2] = {values.size(), 1};
    return made(
        Mat_VarCreate(nullptr, MAT_C_DOUBLE, MAT_T_DOUBLE, 2, size, const_cast<double*>(values.data()), 0));
}

matvar_t* text_variable(const std::string& text) {
    std::size_t size[2] = {text.empty() ? std::size_t{0} : std::size_t{1}, text.size()};
    return made(Mat_VarCreate(nullptr, MAT_C_CHAR, MAT_T_UTF8, 2, size, const_cast<char*>(text.data()), 0));
}

MatVariable struct_variable(const char* name, const std::vector<std::string>& fields) {
    std::vector<const char*> names;
    for (const std::string& field : fields) names.push_back(field.c_str());
    std::size_t size[2] = {1, 1};
    return MatVariable(
        made(Mat_VarCreateStruct(name, 2, size, names.data(), static_cast<unsigned>(names.size()))));
}

MatVariable series_variable(const Series& series, const std::string& name) {
    MatlabNames field_of;
    std::vector<std::string> fields{field_of("t")};
    field_of("units");
    for (const SeriesChannel& channel : series.channels) fields.push_back(field_of(channel.name));
    MatVariable units = struct_variable("units", fields);
    Mat_VarSetStructFieldByName(units.get(), "t", 0, text_variable("s"));
    for (std::size_t k = 0; k < series.channels.size(); ++k)
        Mat_VarSetStructFieldByName(units.get(), fields[k + 1].c_str(), 0,
                                    text_variable(series.channels[k].unit));
    fields.push_back("units");
    MatVariable variable = struct_variable(name.c_str(), fields);
    Mat_VarSetStructFieldByName(variable.get(), "t", 0, vector_variable(series.time_s));
    for (std::size_t k = 0; k < series.channels.size(); ++k)
        Mat_VarSetStructFieldByName(variable.get(), fields[k + 1].c_str(), 0,
                                    vector_variable(series.channels[k].values));
    Mat_VarSetStructFieldByName(variable.get(), "units", 0, units.release());
    return variable;
}

}  // namespace

void write_mat_file(const std::filesystem::path& path, const std::vector<Series>& series) {
    const std::filesystem::path part = path.string() + ".part";
    try {
        // libmatio's own head has the time of day.
        const std::unique_ptr<mat_t, CloseMatFile> file(
            Mat_CreateVer(part.c_str(), "MATLAB 5.0 MAT-file, written by capstan", MAT_FT_MAT5));
        if (!file)
            throw std::runtime_error(fmt::format("cannot write {}; does its folder exist?", path.string()));
        MatlabNames variable_of;
        for (const Series& each : series) {
            const MatVariable variable = series_variable(each, variable_of(each.name));
            if (Mat_VarWrite(file.get(), variable.get(), MAT_COMPRESSION_ZLIB) != 0)
                throw std::runtime_error(fmt::format("cannot write {}; is the disk full?", path.string()));
        }
    } catch (...) {
        std::error_code ignored;
        std::filesystem::remove(part, ignored);
        throw;
    }
    rename_durably(part, path);
}

}  // namespace capstan::exports
