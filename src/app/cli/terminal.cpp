#include "app/cli/terminal.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <mutex>

namespace heliodon::cli {
namespace {

// A signal handler can reach nothing but a static.
volatile std::sig_atomic_t interrupt_seen = 0;

std::string one_line(std::string text) {
    for (char& c : text)
        if (c == '\n' || c == '\r') c = ' ';
    while (!text.empty() && text.back() == ' ') text.pop_back();
    return text;
}

void write_line(std::FILE* stream, const std::string& line) {
    std::fputs((line + "\n").c_str(), stream);
    std::fflush(stream);
}

std::string duration(double seconds) {
    const auto whole = static_cast<long>(std::ceil(seconds));
    if (whole < 60) return fmt::format("{} s", whole);
    if (whole < 3600) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
    return fmt::format("{} h {:02} min", whole / 3600, whole / 60 % 60);
}

}  // namespace

void report_error(const Error& error) {
    write_line(stderr, "heliodon: " + one_line(error.text()));
}

void report_warnings(const Warnings& warnings) {
    for (const Error& warning : warnings) write_line(stderr, "heliodon: warning: " + one_line(warning.text()));
}

void say(const std::string& line) {
    write_line(stderr, line);
}

Result<void> print(const std::string& text) {
    const bool written = std::fwrite(text.data(), 1, text.size(), stdout) == text.size();
    if (std::fflush(stdout) != 0 || !written)
        return fail("standard output", std::string("cannot write: ") + std::strerror(errno));
    return {};
}

void catch_interrupt() {
    struct sigaction action = {};
    action.sa_handler = [](int) { interrupt_seen = 1; };
    action.sa_flags = static_cast<int>(SA_RESETHAND);  // a second Ctrl-C ends the program
    sigaction(SIGINT, &action, nullptr);
}

bool interrupted() {
    return interrupt_seen != 0;
}

struct ProgressBar::State {
    using Clock = std::chrono::steady_clock;
    std::string label;
    bool terminal = isatty(STDERR_FILENO) == 1;
    bool shown = false;
    Clock::time_point begin = Clock::now();
    Clock::time_point drawn = begin;
    std::mutex mutex;  // the work may report from any of its threads

    void draw(double fraction) {
        const auto now = Clock::now();
        const std::scoped_lock lock(mutex);
        using namespace std::chrono_literals;
        if (!terminal || now - begin < 1s || now - drawn < 100ms) return;
        drawn = now;
        shown = true;
        constexpr int cells = 30;
        const double done = std::clamp(fraction, 0.0, 1.0);
        const double elapsed = std::chrono::duration<double>(now - begin).count();
        const int filled = static_cast<int>(done * cells);
        const std::string left = done > 0 ? duration(elapsed * (1 - done) / done) + " left" : "";
        const std::string line = fmt::format("\r{} [{:=<{}}{:<{}}] {:3.0f} % {}\x1b[K", label, "", filled, "",
                                             cells - filled, 100 * done, left);
        std::fputs(line.c_str(), stderr);
        std::fflush(stderr);
    }
};

ProgressBar::ProgressBar(std::string label) : state_(std::make_unique<State>()) {
    catch_interrupt();
    state_->label = std::move(label);
}

ProgressBar::~ProgressBar() {
    if (state_->shown) std::fputs("\r\x1b[K", stderr);
}

Progress ProgressBar::callback() {
    return [state = state_.get()](double fraction) {
        state->draw(fraction);
        return !interrupted();
    };
}

}  // namespace heliodon::cli
