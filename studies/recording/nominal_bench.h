#pragma once
// What a recording's description states of its bench, and what is taken where it states nothing.

#include <fmt/format.h>

#include <string>
#include <vector>

#include "capstan/recording/json_object.h"
#include "capstan/recording/recording.h"

namespace capstan {

/// Says what was taken in place of a key.
class Assumptions {
  public:
    Assumptions(std::string file, std::vector<std::string>& said) : file_(std::move(file)), said_(&said) {}
    void add(const std::string& key, const std::string& taken) {
        said_->push_back(fmt::format("{}: {} is missing; {}", file_, key, taken));
    }
    void add_sentence(const std::string& words) { said_->push_back(file_ + ": " + words); }

  private:
    std::string file_;
    std::vector<std::string>* said_;
};

/// A nominal number, and the standard deviation of its logarithm.
struct StatedNumber {
    double value = 0.0;
    double spread = 0.0;
};

/// A positive number, or a range [low, high] that holds it with a probability of 95%.
StatedNumber value_or_range(const JsonObject& object, const char* key);

/// Notes a problem where a positive number is smaller or larger than anything that is built (`built`, in
/// `unit`): it is in another unit, or a slip. `is` goes before the value in the message.
void check_size(const JsonObject& object, const char* key, double value, std::pair<double, double> built,
                const char* unit, const char* is = "is");

/// Of the section `nominal`; what is missing is taken as usual in the field, and said.
NominalBench nominal_of(const JsonObject& nominal, Assumptions& assumptions);

/// A model of known geometry needs the pretension of each run. Where no run states one, all are taken alike.
void complete_pretensions(const JsonObject& sidecar, Recording& recording, Assumptions& assumptions);

}  // namespace capstan
