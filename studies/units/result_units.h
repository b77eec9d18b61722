#pragma once

#include <functional>
#include <string>
#include <vector>

#include "capstan/units/unit_worker.h"

namespace capstan::units {

/// A text as a JSON string; bytes that are no UTF-8 are replaced.
std::string quoted_json(const std::string& text);

/// Units whose results are texts (JSON), each in a file of its own, kept with its SHA-256.
struct ResultUnits {
    std::string head;                 ///< what the merged file says first: JSON members, each with a comma
    std::vector<std::string> inputs;  ///< what each unit is for, in their order
    std::string computed_with;        ///< this program; results of different ones are not joined
};

/// What a unit gives: complete with its text, stopped, or failed.
struct Result {
    WorkEnd end = WorkEnd::stopped;
    std::string text{};
};

/// Computes such units and merges them into results.json, in the folder `results`, with the records in
/// `leases`.
class ResultWork final : public UnitWork {
  public:
    using Produce = std::function<Result(int unit, const std::function<bool()>& is_unwanted)>;

    ResultWork(SharedFolder& leases, SharedFolder& results, ResultUnits units, Produce produce,
               std::function<bool()> stop_requested)
        : leases_(leases),
          results_(results),
          units_(std::move(units)),
          produce_(std::move(produce)),
          stop_requested_(std::move(stop_requested)) {}

    int count() const override { return static_cast<int>(units_.inputs.size()); }
    bool is_merged() override;
    bool stop_requested() const override { return stop_requested_(); }
    Computed compute(int unit, bool is_second, const std::function<bool()>& is_unwanted) override;
    void discard(const std::string& file) override;

    /// Writes of each unit its input, its result and the result's hash, then the hash over them. Damaged are
    /// units whose file or record is incomplete or damaged. Throws std::runtime_error where different programs or SIMD
    /// widths computed the units.
    Merged merge() override;

  private:
    SharedFolder& leases_;
    SharedFolder& results_;
    ResultUnits units_;
    Produce produce_;
    std::function<bool()> stop_requested_;
};

inline const std::string merged_results = "results.json";

/// What is wrong with merged results: each is compared with its hash, and the hashes with that over them.
/// Empty: nothing.
std::vector<std::string> problems_of_results(const std::string& results_json);

}  // namespace capstan::units
