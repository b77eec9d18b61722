#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "capstan/logs/log.h"

namespace capstan::imports {

/// The names of files without their folders, between commas.
std::string file_names(const std::vector<std::filesystem::path>& files);

/// Reads all files; they share the options' memory limit. `on_progress` gets the fraction of their
/// bytes. Throws InvalidInput where one is given twice, or as logs::read_log().
std::vector<std::unique_ptr<logs::Log>> read_logs(const std::vector<std::filesystem::path>& files,
                                                  logs::ReadOptions options,
                                                  const std::function<void(double)>& on_progress);

/// Index of the column of that name, or of that number from 1; -1: there is none.
int find_column(const logs::LogTable& table, const std::string& wanted);

/// Each column's table and name. Logs with the same are runs of one bench.
std::vector<std::string> column_names(const logs::Log& log);

/// The unit that the file states for a column, or that its name ends in ("angle_deg"); empty: none.
std::string stated_unit(const logs::LogColumn& column);

}  // namespace capstan::imports
