// Delimited text as instruments, spreadsheets and scripts write it.
#include <gmock/gmock.h>
#include <zlib.h>

#include <cmath>

#include "capstan/logs/text_cells.h"
#include "sample_log.h"

namespace capstan::logs {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::NanSensitiveDoubleEq;

constexpr double missing = std::numeric_limits<double>::quiet_NaN();

struct TextCase {
    const char* name;
    std::string text;
    std::vector<std::string> names;
    std::vector<std::string> units;
    std::vector<double> first_column;
    std::vector<double> last_column;
};

class TextFiles : public testing::TestWithParam<TextCase> {};

TEST_P(TextFiles, AreReadAsTheyWereMeant) {
    const TextCase& sample = GetParam();
    const Log log = read_log(log_file(sample.name, sample.text));
    ASSERT_EQ(log.tables.size(), 1u);
    const LogTable& table = log.tables[0];
    EXPECT_EQ(column_names(table), sample.names);
    std::vector<std::string> units;
    for (const LogColumn& column : table.columns) units.push_back(column.unit);
    EXPECT_EQ(units, sample.units);
    EXPECT_EQ(table.rows, sample.first_column.size());
    const auto same = [](const std::vector<double>& got, const std::vector<double>& meant) {
        ASSERT_EQ(got.size(), meant.size());
        for (std::size_t row = 0; row < got.size(); ++row)
            EXPECT_THAT(got[row], NanSensitiveDoubleEq(meant[row])) << "row " << row;
    };
    same(numbers_of(table.columns.front().values), sample.first_column);
    same(numbers_of(table.columns.back().values), sample.last_column);
}

std::string utf16(const std::string& ascii) {
    std::string text = "\xff\xfe";
    for (const char letter : ascii) (text += letter) += '\0';
    return text;
}

INSTANTIATE_TEST_SUITE_P(
    Text, TextFiles,
    testing::Values(
        TextCase{"plain", "t,x\n0,1\n0.5,2\n", {"t", "x"}, {"", ""}, {0, 0.5}, {1, 2}},
        TextCase{"headless", "0 1\n1 2\n", {"column_1", "column_2"}, {"", ""}, {0, 1}, {1, 2}},
        TextCase{"one_column", "1.5\n2.5\n", {"column_1"}, {""}, {1.5, 2.5}, {1.5, 2.5}},
        TextCase{"one_row_below_its_head", "a;b\n1,5;2\n", {"a", "b"}, {"", ""}, {1.5}, {2}},
        TextCase{"units_in_the_head",
                 "time_ms,Torque [N m],angle (deg),x(1)\n0,1,2,3\n",
                 {"time_ms", "Torque", "angle", "x(1)"},
                 {"", "N m", "deg", ""},
                 {0},
                 {3}},
        TextCase{"units_below_the_head",
                 "time;force\n[s];[N]\n0;1\n1;2\n",
                 {"time", "force"},
                 {"s", "N"},
                 {0, 1},
                 {1, 2}},
        TextCase{"bare_units_below_the_head",
                 "time\tforce\ns\tN\n0\t1\n",
                 {"time", "force"},
                 {"s", "N"},
                 {0},
                 {1}},
        TextCase{"head_of_numpy", "# time force\n0,1\n1,2\n", {"time", "force"}, {"", ""}, {0, 1}, {1, 2}},
        TextCase{
            "units_in_a_comment", "% time, force\n% s, N\n0,1\n", {"time", "force"}, {"s", "N"}, {0}, {1}},
        TextCase{"commented_data_are_no_head", "#1,2\n3,4\n", {"column_1", "column_2"}, {"", ""}, {3}, {4}},
        TextCase{"decimal_commas",
                 "t;F\n0,001;-1,5e-3\n0,002;2\n",
                 {"t", "F"},
                 {"", ""},
                 {0.001, 0.002},
                 {-0.0015, 2}},
        TextCase{"decimal_commas_and_tabs", "t\tF\n0,25\t1,5\n", {"t", "F"}, {"", ""}, {0.25}, {1.5}},
        TextCase{"decimal_commas_and_blanks",
                 "0,25 1,5\n0,5 2,5\n",
                 {"column_1", "column_2"},
                 {"", ""},
                 {0.25, 0.5},
                 {1.5, 2.5}},
        TextCase{"bar", "a|b\n1|2\n", {"a", "b"}, {"", ""}, {1}, {2}},
        TextCase{"padded_blanks",
                 "   t      x\n   0.0    1\n  10.0   22\n",
                 {"t", "x"},
                 {"", ""},
                 {0, 10},
                 {1, 22}},
        TextCase{"blanks_after_commas", "t, x\n0, 1\n1, 2\n", {"t", "x"}, {"", ""}, {0, 1}, {1, 2}},
        TextCase{"head_of_blanks_with_units",
                 "Time [s] Load [N m]\n0 1\n",
                 {"Time", "Load"},
                 {"s", "N m"},
                 {0},
                 {1}},
        TextCase{"quotes", "\"t\",\"a, b\"\n\"0\",\"1.5\"\n", {"t", "a, b"}, {"", ""}, {0}, {1.5}},
        TextCase{"byte_order_mark", "\xef\xbb\xbft,x\r\n0,1\r\n", {"t", "x"}, {"", ""}, {0}, {1}},
        TextCase{"lone_carriage_returns", "t,x\r0,1\r1,2\r", {"t", "x"}, {"", ""}, {0, 1}, {1, 2}},
        TextCase{"utf16", utf16("t;x\r\n0,5;1\r\n"), {"t", "x"}, {"", ""}, {0.5}, {1}},
        TextCase{"latin_1", "t,angle (\xb0)\n0,1\n", {"t", "angle"}, {"", "\xc2\xb0"}, {0}, {1}},
        TextCase{"missing_cells",
                 "t,x\n0,\n1,nan\n2,-\n3,inf\n4,1e999\n5,7\n",
                 {"t", "x"},
                 {"", ""},
                 {0, 1, 2, 3, 4, 5},
                 {missing, missing, missing, missing, missing, 7}},
        TextCase{"unusual_numbers",
                 "t,x\n+1,1D3\n.5,-1e-400\n1.,0x\n",
                 {"t", "x"},
                 {"", ""},
                 {1, 0.5, 1},
                 {1000, 0, missing}},
        TextCase{"same_names", "t,x,x\n0,1,2\n", {"t", "x", "x.2"}, {"", "", ""}, {0}, {2}},
        TextCase{"names_left_out", "t,,x\n0,1,2\n", {"t", "column_2", "x"}, {"", "", ""}, {0}, {2}},
        TextCase{"delimiter_at_the_end", "t,x,\n0,1,\n1,2,\n", {"t", "x"}, {"", ""}, {0, 1}, {1, 2}},
        TextCase{"delimiter_at_the_end_of_data", "t,x\n0,1,\n1,2,\n", {"t", "x"}, {"", ""}, {0, 1}, {1, 2}},
        TextCase{"lines_of_a_preamble",
                 "Sensor log\nrate: 1000\nt;x\n0;1\n1;2\n2;3\n",
                 {"t", "x"},
                 {"", ""},
                 {0, 1, 2},
                 {1, 2, 3}},
        TextCase{"dots_of_thousands",
                 "Zeit;Kraft\ns;N\n1.234,5;2,0\n1.234.567,6;-2,1\n",
                 {"Zeit", "Kraft"},
                 {"s", "N"},
                 {1234.5, 1234567.6},
                 {2, -2.1}},
        TextCase{
            "labview",
            "LabVIEW Measurement\nSeparator\tTab\nDate\t2024/05/01\t2024/05/01\nX_Value\tVoltage\tForce\tComment\n0,000\t1,5\t2,5\n0,001\t1,6\t2,6\n",
            {"X_Value", "Voltage", "Force"},
            {"", "", ""},
            {0, 0.001},
            {2.5, 2.6}},
        TextCase{"head_of_rostopic",
                 "%time,field.header.seq,field.data\n1700000000,1,0.5\n1700000001,2,0.75\n",
                 {"time", "field.header.seq", "field.data"},
                 {"", "", ""},
                 {1700000000, 1700000001},
                 {0.5, 0.75}},
        TextCase{
            "comments_between", "t,x\n0,1\n# pause\n// again\n1,2\n", {"t", "x"}, {"", ""}, {0, 1}, {1, 2}}),
    [](const auto& the) { return std::string(the.param.name); });

TEST(TextLog, ReadsTheHeadOfTheDaVinciGripFiles) {
    const std::filesystem::path file =
        std::filesystem::path(CAPSTAN_REAL_RECORDINGS) / "davinci-grip/raw/Tool_4_Maryland_L_4_00.TXT";
    if (!std::filesystem::exists(file)) GTEST_SKIP() << "no recordings at " << file;
    const Log log = read_log(file);
    const LogTable& table = log.tables.at(0);
    EXPECT_THAT(column_names(table),
                ElementsAre("Back-end Time", "Back-end CUI Encoder", "Back-end Futek Torque",
                            "Measured Current", "Front-end Maxon Encoder", "Front-end Futek Torque",
                            "Front-end Command", "Back-end Command", "Back-end Maxon", "Trajectory Target"));
    EXPECT_EQ(table.columns[0].unit, "ms");
    EXPECT_EQ(table.columns[3].unit, "Amps");
    EXPECT_EQ(numbers_of(table.columns[5].values, 2), (std::vector<double>{-220, -214}));
    EXPECT_EQ(log.text.head_line, 12);
}

TEST(TextLog, ReadsIsoTimesAsSecondsSinceTheFirstAndSaysSo) {
    const Log log =
        log_of("when,x\n2024-05-01T10:00:00.25Z,1\n2024-05-01 10:00:01.5,2\n2024-05-02T00:00:00+02:00,3\n");
    EXPECT_EQ(log.tables[0].columns[0].unit, "s");
    EXPECT_THAT(numbers_in(log.tables[0], "when"), ElementsAre(0.0, 1.25, 43199.75));
    EXPECT_THAT(log.assumptions,
                ElementsAre("'when' is read as seconds since its first row, 2024-05-01T10:00:00.25Z"));
}

struct DateCase {
    const char* name;
    std::string text;
    std::vector<double> seconds;
    std::string assumed;  ///< behind the first row
};

class DatesWithTheYearLast : public testing::TestWithParam<DateCase> {};

TEST_P(DatesWithTheYearLast, AreAClockAndAGuessedOrderIsStated) {
    const Log log = read_log(log_file(GetParam().name, GetParam().text));
    EXPECT_THAT(numbers_in(log.tables[0], "when"), testing::ElementsAreArray(GetParam().seconds));
    ASSERT_EQ(log.assumptions.size(), 1u);
    EXPECT_THAT(log.assumptions[0], testing::EndsWith(GetParam().assumed));
    EXPECT_THAT(log.remarks, IsEmpty());
}

INSTANTIATE_TEST_SUITE_P(
    Text, DatesWithTheYearLast,
    testing::Values(
        DateCase{
            "one_day",
            "when;x\n01.05.2024 12:00:03;1\n01.05.2024 12:00:03,5;2\n",
            {0, 0.5},
            ", 01.05.2024 12:00:03, taken as 2024-05-01 with the day first: a guess, on which no time depends, "
            "as all rows have this date"},
        DateCase{"only_one_reading",
                 "when,x\n31.05.2024 23:59:59,1\n01.06.2024 00:00:00.25,2\n",
                 {0, 1.25},
                 ", 31.05.2024 23:59:59"},
        DateCase{"slashes_of_america",
                 "when,x\n5/1/2024 11:59:59 PM,1\n5/2/2024 12:00:00 AM,2\n",
                 {0, 1},
                 "taken as 2024-05-01 with the month first: the next date then follows it more closely"},
        DateCase{"slashes_of_europe",
                 "when,x\n01/05/2024 23:59:59,1\n02/05/2024 00:00:00,2\n",
                 {0, 1},
                 "taken as 2024-05-01 with the day first: the next date then follows it more closely"},
        DateCase{"a_later_day_above_twelve",
                 "when,x\n12/05/2024 23:59:59,1\n13/05/2024 00:00:00,2\n14/05/2024 00:00:00,3\n",
                 {0, 1, 86401},
                 "taken as 2024-05-12 with the day first: a later date has no other reading"},
        DateCase{"not_back_in_time",
                 "when,x\n01-02-2024 00:00:00,1\n02-01-2024 00:00:00,2\n",
                 {0, 30 * 86400.0},
                 "with the month first: the next date then follows it more closely"},
        DateCase{"noon_and_midnight",
                 "when,x\n1/1/2024 12:00:00 am,1\n1/1/2024 1:00:00 am,2\n1/1/2024 12:00:00 pm,3\n",
                 {0, 3600, 43200},
                 ", 1/1/2024 12:00:00 am"}),
    [](const auto& the) { return std::string(the.param.name); });

TEST(TextLog, TakesNoVersionOrAddressForADate) {
    for (const char* cell : {"1.2.3", "10.0.0.1", "32.13.2024", "1.5.24", "01.05/2024", "01.05.2024 25:00:00",
                             "13/13/2024", "1/5/2024 13:00:00 PM", "0/0/2024"})
        EXPECT_FALSE(instant_of_cell(cell)) << cell;
    EXPECT_FALSE(instant_of_cell("13.05.2024", DateOrder::month_first));
}

TEST(TextLog, LeavesColumnsOfTextOutAndNamesThem) {
    const Log log = log_of("t,phase,x\n0,go,1\n1,stop,2\n");
    EXPECT_THAT(column_names(log.tables[0]), ElementsAre("t", "x"));
    EXPECT_THAT(remarks_of(log), HasSubstr("A column of text is left out: phase"));
}

TEST(TextLog, TellsHowManyLinesWereLeftOutAndWhereTheFirstIs) {
    const Log log = log_of("t,x\n0,1\n1\n2,2\n3,3,3\n4,4\n5\nt,x\n6,6\n");
    EXPECT_THAT(numbers_in(log.tables[0], "t"), ElementsAre(0, 2, 4, 6));
    EXPECT_THAT(remarks_of(log), HasSubstr("2 lines, the first is line 3: they have fewer than 2 fields"));
    EXPECT_THAT(remarks_of(log), HasSubstr("Line 5: it has more than 2 fields"));
    EXPECT_THAT(remarks_of(log), HasSubstr("Line 8: it has text where numbers belong and is left out"));
}

TEST(TextLog, ReadsTextInAColumnOfNumbersAsMissingAndSaysWhere) {
    const Log log = log_of("t,x\n0,1\n1,overflow\n2,3\n");
    EXPECT_TRUE(std::isnan(numbers_in(log.tables[0], "x")[1]));
    EXPECT_THAT(remarks_of(log), HasSubstr("Line 3: 'x' has no number there"));
}

TEST(TextLog, LeavesAnIncompleteLastLineOutAndSaysSo) {
    const Log cut = log_of("t,x\n0,1\n1,2\n2");
    EXPECT_EQ(cut.tables[0].rows, 2u);
    EXPECT_THAT(remarks_of(cut), HasSubstr("line, 4, is incomplete"));
    const Log doubtful = log_of("t,x\n0,1\n1,2");
    EXPECT_EQ(doubtful.tables[0].rows, 2u);
    EXPECT_THAT(remarks_of(doubtful), HasSubstr("has no line end"));
    EXPECT_THAT(log_of("t,x\n0,1\n1,2\n").remarks, IsEmpty());
}

TEST(TextLog, ObeysWhatIsStated) {
    ReadOptions options;
    options.text.head_line = 0;
    EXPECT_THAT(column_names(log_of("1,2\n3,4\n", options).tables[0]), ElementsAre("column_1", "column_2"));
    options.text.head_line = 1;
    EXPECT_EQ(log_of("1,2\n3,4\n", options).tables[0].rows, 1u);
    options.text = {':', std::nullopt, std::nullopt, std::nullopt};
    EXPECT_THAT(numbers_in(log_of("a:b\n1:2\n2:4\n", options).tables[0], "b"), ElementsAre(2, 4));
    options.text = {std::nullopt, std::nullopt, std::nullopt, "!"};
    EXPECT_THAT(column_names(log_of("! a,b\n0,1\n! pause\n1,2\n", options).tables[0]), ElementsAre("a", "b"));
    options.text = {std::nullopt, std::nullopt, 9, std::nullopt};
    EXPECT_THAT(refusal_of("1,2\n3,4\n", options), HasSubstr("line 9 is to be the head"));
}

TEST(TextLog, KeepsOnlyTheWantedColumns) {
    ReadOptions options;
    options.wanted = [](const std::string&, const std::string& column) { return column == "b"; };
    const Log log = log_of("a,b,c\n1,2,3\n", options);
    EXPECT_THAT(column_names(log.tables[0]), ElementsAre("b"));
    EXPECT_THAT(numbers_in(log.tables[0], "b"), ElementsAre(2));
}

TEST(TextLog, RefusesWhatHasNoNumbers) {
    EXPECT_THAT(refusal_of("to be or\nnot to be\n"), HasSubstr("no line of numbers"));
    EXPECT_THAT(refusal_of("\n\n"), HasSubstr("no line of numbers"));
    EXPECT_THAT(refusal_of(""), HasSubstr("is empty"));
    EXPECT_THAT(refusal_of(std::string(3u << 20, '7')), HasSubstr("line 1 has more than"));
    std::string wide;
    for (int column = 0; column < 5000; ++column) wide += "1,";
    EXPECT_THAT(refusal_of(wide + "1\n"), HasSubstr("more than 4096 columns"));
}

std::string gzipped(const std::string& text) {
    std::string packed(compressBound(text.size()) + 64, '\0');
    z_stream stream{};
    deflateInit2(&stream, 9, Z_DEFLATED, 16 + MAX_WBITS, 8, Z_DEFAULT_STRATEGY);
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(text.data()));
    stream.avail_in = static_cast<uInt>(text.size());
    stream.next_out = reinterpret_cast<Bytef*>(packed.data());
    stream.avail_out = static_cast<uInt>(packed.size());
    deflate(&stream, Z_FINISH);
    packed.resize(stream.total_out);
    deflateEnd(&stream);
    return packed;
}

TEST(TextLog, UnpacksGzipButNoBomb) {
    const Log log = log_of(gzipped("t,x\n0,1\n") + gzipped("1,2\n"));
    EXPECT_THAT(numbers_in(log.tables[0], "x"), ElementsAre(1, 2));
    std::string zeros;
    while (zeros.size() < 100u << 20)
        zeros += "0,000000000000000000000000000000000000000000000000000000000000000000000000000\n";
    EXPECT_THAT(refusal_of(gzipped(zeros)), HasSubstr("unpacks to more than 100 times"));
}

TEST(TextLog, SaysThatACompressedFileIsCut) {
    std::string text = "t,x\n";
    for (long row = 0; row < 50'000; ++row)
        text += std::to_string(row) + "," + std::to_string(row * row % 977) + "\n";
    const std::string packed = gzipped(text);
    EXPECT_THAT(log_of(packed).remarks, IsEmpty());
    for (std::size_t part = 1; part < 50; ++part) {
        const std::string cut = packed.substr(0, packed.size() * part / 50);
        const std::string refusal = refusal_of(cut);
        if (refusal.empty()) {
            EXPECT_THAT(remarks_of(log_of(cut)), HasSubstr("The compressed file is cut")) << part;
        }
    }
}

TEST(TextLog, IsTheSameHoweverManyNumbersStayInMemory) {
    std::string text = "t,x\n";
    for (int row = 0; row < 100'000; ++row)
        text += std::to_string(row) + "," + std::to_string(row * 0.5) + "\n";
    ReadOptions options;
    options.memory_limit_bytes = 0;
    const Log on_disk = log_of(text, options);
    const Log in_memory = log_of(text);
    EXPECT_EQ(numbers_in(on_disk.tables[0], "x"), numbers_in(in_memory.tables[0], "x"));
    EXPECT_EQ(numbers_in(on_disk.tables[0], "t").at(99'999), 99'999.0);
}

}  // namespace
}  // namespace capstan::logs
