#pragma once

#include <chrono>
#include <memory>
#include <string>

#include "core/progress.h"
#include "core/result.h"

namespace heliodon::cli {

/// `heliodon: where: message` on standard error, always one line.
void report_error(const Error& error);
/// `heliodon: warning: where: message`, one line each.
void report_warnings(const Warnings& warnings);
/// A plain line on standard error: what a person wants to know beside the results.
void say(const std::string& line);
/// Results, on standard output; an error where they do not arrive there (a full disk).
Result<void> print(const std::string& text);

/// From the first call on, Ctrl-C asks the running work to stop instead of ending the program (a second one
/// ends it). Whoever writes files asks `interrupted` first.
void catch_interrupt();
[[nodiscard]] bool interrupted();

/// Shows a bar with the time left on standard error, when that is a terminal and the work takes over a
/// second; clears it when destroyed. Its callback asks the work to stop after Ctrl-C.
class ProgressBar {
public:
    explicit ProgressBar(std::string label);
    ~ProgressBar();
    ProgressBar(const ProgressBar&) = delete;
    ProgressBar& operator=(const ProgressBar&) = delete;

    [[nodiscard]] Progress callback();

private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace heliodon::cli
