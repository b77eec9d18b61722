#pragma once
// Every table, view, column and unit in words, read from schema.sql: the comments beside the DDL are the one
// home of these words.

#include <string>
#include <vector>

namespace capstan::storage {

struct DocumentedColumn {
    std::string name;
    std::string type;     // 'INTEGER', 'REAL', 'TEXT'; '' for what a view computes
    std::string unit;     // 'N', 'm', ...; '' for a number without a unit
    std::string meaning;  // a column without words of its own has those of the first column of its name
    bool is_key = false;
    bool may_be_null = false;
};

struct DocumentedTable {
    std::string name;
    bool is_view = false;
    std::string meaning;
    std::vector<DocumentedColumn> columns;
};

std::vector<DocumentedTable> schema_documentation();  // in the order of schema.sql

// The same as Markdown, as storage/README.md has it.
std::string schema_markdown();

}  // namespace capstan::storage
