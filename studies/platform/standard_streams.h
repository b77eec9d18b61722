#pragma once

#include <string>
#include <string_view>

namespace capstan {

/// The text with every control character but line ends and tabs, and every mark that turns the direction of
/// writing, as \\x1b, so that no name that a file holds can steer a terminal.
std::string printable(std::string_view text);

/// Writes a message to standard error, printable, and ends its line if the message does not. Never throws and
/// never ends the program: a study goes on when its terminal is closed or the disk of its log is full.
void say(std::string_view message) noexcept;

/// As `say`, without a line end.
void write_standard_error(std::string_view text) noexcept;

/// Writes to standard output, printable if that is a terminal, and makes sure that the text arrived. Throws
/// std::runtime_error if it did not.
void write_standard_output(std::string_view text);

/// Opens /dev/null for each standard stream that is closed, so that no other file gets its number and
/// receives the messages. The first call of main().
void reserve_standard_streams() noexcept;

bool standard_error_is_terminal() noexcept;

/// All of the text, in as many writes as it takes; false, and errno, if it cannot be written.
bool write_all(int descriptor, std::string_view text) noexcept;

}  // namespace capstan
