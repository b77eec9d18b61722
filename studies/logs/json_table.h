#pragma once

#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "capstan/logs/table_writer.h"

namespace capstan::logs {

/// The JSON messages of one topic as a table: log_time, then every number by its path ("motor.angle",
/// "joints.0"). An object of seconds and nanoseconds is one time [s]. Text is left out.
class JsonTable {
  public:
    JsonTable(TableWriter& writer, const std::string& topic);

    void take(std::uint64_t log_time_ns, std::string_view message);
    void end();

  private:
    void read(const nlohmann::json& value, const std::string& path, int depth);
    void write(const std::string& path, double number);

    TableWriter& writer_;
    std::string topic_;
    int table_;
    int time_column_;
    std::map<std::string, int> columns_;
    std::size_t messages_ = 0;
    std::size_t misfits_ = 0;
    bool is_left_out_in_part_ = false;
};

}  // namespace capstan::logs
