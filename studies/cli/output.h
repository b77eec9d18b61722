#pragma once

#include <string_view>

#include "capstan/cli/command.h"
#include "capstan/platform/files.h"
#include "capstan/platform/progress.h"
#include "capstan/platform/standard_streams.h"
#include "capstan/platform/work_meter.h"
#include "capstan/reports/answer.h"

namespace capstan::cli {

/// Writes a text where --output says.
void deliver(const Invocation& invocation, std::string_view text);

/// Writes the page of an answer where --html says, if it does, and says so on standard error.
void deliver_page(const Invocation& invocation, const reports::Answer& answer);

/// Writes an answer where --output says, in the form that --json, --format or the ending of the file's name
/// asks for, else as text; and its page where --html says.
void deliver_answer(const Invocation& invocation, const reports::Answer& answer);

/// The form of an answer as the options ask for it, else `otherwise`.
reports::AnswerFormat answer_format(const Invocation& invocation, reports::AnswerFormat otherwise);

/// While it lives, the work of this thread is shown as --progress says, with the time left. Work of less than
/// a second shows nothing.
class ShownWork {
  public:
    ShownWork(const Invocation& invocation, std::string activity);
    ~ShownWork();
    ShownWork(const ShownWork&) = delete;
    ShownWork& operator=(const ShownWork&) = delete;

    /// All of it is done.
    void end();

  private:
    void show(double fraction);

    std::string activity_;
    ProgressDisplay display_;
    WorkMeter meter_;
    MeterScope scope_;
};

}  // namespace capstan::cli
