#pragma once
// What a study says, as one neutral value: for people as sections of prose, tables and figures, for programs
// as a tree of values. Every format is made of this.

#include <string>
#include <vector>

#include "capstan/reports/data.h"
#include "capstan/reports/table.h"

namespace capstan::reports {

/// A column of an answer's table: which value of a row it shows, and how.
struct Column {
    std::string path;      ///< of the value within a row, "optimum.error_N"
    std::string title;     ///< for people
    std::string unit{};    ///< empty: none
    std::string format{};  ///< of a number: ".3f", "+.3f", ".1%", else four digits; "wrap": long texts
    std::string (*words)(const std::string& name) = nullptr;  ///< a name as people read it; CSV has the name
};

/// Rows to read. A value that is missing reads "-"; a list of two numbers "0.1 to 0.2".
struct AnswerTable {
    std::string id;  ///< in CSV
    std::string caption;
    std::vector<Column> columns;
    Data rows;                  ///< a list of records
    std::size_t max_shown = 0;  ///< rows that people see; 0: all. CSV has all.
};

struct AnswerSection {
    std::string id;  ///< of its figures, and of its place on the page
    std::string heading{};
    std::string prose{};
    std::vector<AnswerTable> tables{};
    std::string note{};  ///< below the tables and figures
};

struct Answer {
    std::string id;          ///< whose figures: `page` of their specifications
    std::string kind;        ///< "Why a bench disagrees with its model"
    std::string title;       ///< what it is about: the name of a study or a recording
    std::string headline{};  ///< the answer in one sentence
    Data values{};           ///< all of it, for programs
    std::vector<AnswerSection> sections{};
    std::string csv_table{};     ///< the drawn table that is the CSV of this answer; empty: the long form
    std::vector<Table> drawn{};  ///< what the figures draw; a table "run" draws figures for each run
    std::string config_text{};   ///< what was run; empty: nothing to show
};

std::string answer_text(const Answer& answer);  ///< for a terminal, 100 columns
std::string answer_json(const Answer& answer);
/// `csv_table`, or every table in the long form table,row,column,value,unit; in full precision.
std::string answer_csv(const Answer& answer);
std::string answer_markdown(const Answer& answer);
/// One page that needs no network. A figure without rows is left out.
std::string answer_html(const Answer& answer);
/// The same as the page of a study in `capstan serve`, which adds what can be asked there.
std::string answer_live_html(const Answer& answer);

enum class AnswerFormat { text, json, csv, markdown, html };
std::string answer_in(const Answer& answer, AnswerFormat format);

/// A table as a list of records.
Data data_of(const Table& table);

/// The cells of a table as people read them, with a head row "title [unit]".
std::vector<std::vector<std::string>> cells_of(const AnswerTable& table);

/// Of every how many samples one is drawn, so that no more than `limit` are.
std::size_t drawn_every(std::size_t samples, std::size_t limit);

}  // namespace capstan::reports
