#pragma once
// An experiment or a simulation as one page: figures beside the numbers that they show.

#include <string>
#include <vector>

#include "capstan/reports/table.h"

namespace capstan::reports {

// Numbers to read, as text; the first column names the row.
struct NumberTable {
    std::string caption;
    std::vector<std::string> heads;
    std::vector<std::vector<std::string>> rows;  // rows x heads
};

// A heading, words, numbers, and the figures whose specs name this section.
struct ExperimentSection {
    std::string id;
    std::string title;
    std::string intro;
    std::vector<NumberTable> numbers;
    std::string closing;  // below the figures; '': nothing
};

struct ExperimentPage {
    std::string id;  // whose figures: `page` of their specs
    std::string kind;
    std::string title;
    std::string verdict;
    std::vector<ExperimentSection> sections;
    std::vector<Table> tables;  // what the figures draw; a table "run" draws figures per run
    std::string config_text;    // what was run; '': nothing to show
    std::string program_version;
};

// One page that needs no network. A figure without rows is left out.
std::string experiment_page_html(const ExperimentPage& page);

// Every how many samples are drawn, so that no more than `limit` are.
std::size_t drawn_every(std::size_t samples, std::size_t limit);

}  // namespace capstan::reports
