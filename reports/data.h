#pragma once
// A tree of values, as a program reads an answer. Cheap to include: only data.cpp knows the JSON library.

#include <concepts>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace capstan::reports {

/// Nothing, true or false, an integer, a number, a text, a list, or a record of named values in order.
class Data {
  public:
    struct Member;

    Data() = default;
    Data(std::nullptr_t) {}
    Data(bool value) : value_(value) {}
    template <std::integral Integer>
    requires(!std::same_as<Integer, bool>) Data(Integer value) : value_(static_cast<std::int64_t>(value)) {}
    Data(double value) : value_(value) {}
    Data(const char* text) : value_(std::string(text)) {}
    Data(std::string text) : value_(std::move(text)) {}
    Data(std::string_view text) : value_(std::string(text)) {}
    template <class Value>
    Data(const std::optional<Value>& value) {
        if (value) *this = Data(*value);
    }
    template <class Value>
    Data(const std::vector<Value>& values) : value_(std::vector<Data>(values.begin(), values.end())) {}
    /// A record: {{"error_N", 0.1}, {"nodes", nodes}}.
    Data(std::initializer_list<Member> members);

    static Data record() { return Data(Record{}); }
    static Data list() { return Data(std::vector<Data>{}); }
    static Data list(std::initializer_list<Data> items) { return Data(std::vector<Data>(items)); }

    bool is_list() const { return std::holds_alternative<std::vector<Data>>(value_); }
    bool is_nothing() const { return std::holds_alternative<std::monostate>(value_); }
    const bool* boolean() const { return std::get_if<bool>(&value_); }
    const std::int64_t* integer() const { return std::get_if<std::int64_t>(&value_); }
    const double* number() const { return std::get_if<double>(&value_); }
    const std::string* text() const { return std::get_if<std::string>(&value_); }
    /// Of a list; none of anything else.
    const std::vector<Data>& items() const;
    /// Of a record; none of anything else.
    const std::vector<std::string>& names() const;
    const std::vector<Data>& values() const;

    /// The value of that name in a record, added at its end where it is missing; nothing becomes a record.
    Data& operator[](std::string_view name);
    /// The value at a path of names, "optimum.error_N"; null where there is none.
    const Data* find(std::string_view path) const;
    /// Adds to a list; nothing becomes a list.
    void push_back(Data item);
    /// Takes all members of another record.
    void update(const Data& record);

  private:
    struct Record {
        std::vector<std::string> names;
        std::vector<Data> values;  // names
    };
    explicit Data(Record record) : value_(std::move(record)) {}

    std::variant<std::monostate, bool, std::int64_t, double, std::string, std::vector<Data>, Record> value_;
};

struct Data::Member {
    std::string name;
    Data value;
};

/// Indented JSON, ended by a line break. A number that is not finite is null; bytes that are not UTF-8 become
/// the replacement character.
std::string json_text(const Data& data);
/// The same on one line, without a line break.
std::string json_line(const Data& data);

/// The tree of a JSON text. Throws std::runtime_error where the text is not JSON.
Data parse_json(std::string_view text);

}  // namespace capstan::reports
