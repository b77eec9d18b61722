#include "capstan/storage/diagnosis_store.h"

#include <string>

#include "capstan/storage/error.h"
#include "capstan/storage/integrity/content_hash.h"
#include "capstan/storage/record_rows.h"
#include "capstan/storage/transaction.h"

namespace capstan::storage {
namespace {

std::int64_t next_diagnosis_id(Database& database) {
    Statement statement(database, "SELECT coalesce(max(diagnosis_id), 0) + 1 FROM diagnosis");
    statement.step();
    return statement.get<std::int64_t>(0);
}

// Rows that are numbered by their position, the first one `first`.
template <class Record>
void write_numbered(Database& database, const std::string& table, const std::string& number_column, int first,
                    const std::vector<Record>& records, std::int64_t diagnosis_id) {
    RowWriter<Record> rows(database, table, "diagnosis_id, " + number_column);
    int number = first;
    for (const Record& record : records) rows.write(record, diagnosis_id, number++);
}

template <class Record>
std::vector<Record> read_numbered(Database& database, const std::string& table,
                                  const std::string& number_column, std::int64_t diagnosis_id) {
    Statement select(database, "SELECT " + column_names<Record>() + " FROM " + table +
                                   " WHERE diagnosis_id = ?1 ORDER BY " + number_column);
    select.bind(1, diagnosis_id);
    std::vector<Record> records;
    while (select.step()) records.push_back(read_record<Record>(select));
    return records;
}

void write_causes(Database& database, const std::vector<DiagnosisCauseRecord>& causes,
                  std::int64_t diagnosis_id) {
    write_numbered(database, "diagnosis_cause", "cause_index", 0, causes, diagnosis_id);
    RowWriter<DiagnosisNumberRecord> numbers(database, "diagnosis_number", "diagnosis_id, cause_index");
    for (std::size_t k = 0; k < causes.size(); ++k)
        numbers.write_all(causes[k].numbers, diagnosis_id, static_cast<int>(k));
}

std::vector<DiagnosisCauseRecord> read_causes(Database& database, std::int64_t diagnosis_id) {
    auto causes =
        read_numbered<DiagnosisCauseRecord>(database, "diagnosis_cause", "cause_index", diagnosis_id);
    Statement select(database, "SELECT " + column_names<DiagnosisNumberRecord>() +
                                   " FROM diagnosis_number WHERE diagnosis_id = ?1 AND cause_index = ?2 "
                                   "ORDER BY name");
    for (std::size_t k = 0; k < causes.size(); ++k) {
        select.bind_all(diagnosis_id, static_cast<int>(k));
        while (select.step()) causes[k].numbers.push_back(read_record<DiagnosisNumberRecord>(select));
        select.reset();
    }
    return causes;
}

}  // namespace

std::int64_t write_diagnosis(Database& database, const DiagnosisRecord& diagnosis) {
    Transaction transaction(database);
    const std::int64_t id = next_diagnosis_id(database);
    RowWriter<DiagnosisRecord>(database, "diagnosis", "diagnosis_id").write(diagnosis, id);
    write_numbered(database, "diagnosis_effect", "place", 1, diagnosis.effects, id);
    write_causes(database, diagnosis.causes, id);
    write_numbered(database, "diagnosis_candidate", "candidate_index", 0, diagnosis.candidates, id);
    write_numbered(database, "diagnosis_channel", "channel_index", 0, diagnosis.channels, id);
    write_numbered(database, "diagnosis_gap", "part_index", 0, diagnosis.gap, id);
    hash_diagnosis(database, id);
    transaction.commit();
    return id;
}

std::vector<DiagnosisSummary> list_diagnoses(Database& database) {
    Statement select(database,
                     "SELECT diagnosis_id, recording, log_file, verdict, confidence_fraction FROM diagnosis "
                     "ORDER BY diagnosis_id");
    std::vector<DiagnosisSummary> diagnoses;
    while (select.step()) {
        diagnoses.push_back({select.get<std::int64_t>(0), select.get<std::string>(1),
                             select.get<std::string>(2), select.get<std::string>(3), select.get<double>(4)});
    }
    return diagnoses;
}

DiagnosisRecord load_diagnosis(Database& database, std::int64_t diagnosis_id) {
    auto found = read_numbered<DiagnosisRecord>(database, "diagnosis", "diagnosis_id", diagnosis_id);
    if (found.empty()) {
        throw Error(database.path().string() + " holds no diagnosis " + std::to_string(diagnosis_id) +
                    ". `capstan query \"SELECT * FROM v_diagnosis\"` shows what it holds.");
    }
    DiagnosisRecord diagnosis = std::move(found.front());
    diagnosis.diagnosis_id = diagnosis_id;
    diagnosis.effects =
        read_numbered<DiagnosisEffectRecord>(database, "diagnosis_effect", "place", diagnosis_id);
    diagnosis.causes = read_causes(database, diagnosis_id);
    diagnosis.candidates = read_numbered<DiagnosisCandidateRecord>(database, "diagnosis_candidate",
                                                                   "candidate_index", diagnosis_id);
    diagnosis.channels =
        read_numbered<DiagnosisChannelRecord>(database, "diagnosis_channel", "channel_index", diagnosis_id);
    diagnosis.gap = read_numbered<DiagnosisGapRecord>(database, "diagnosis_gap", "part_index", diagnosis_id);
    return diagnosis;
}

}  // namespace capstan::storage
