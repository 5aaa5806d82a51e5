#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

namespace heliodon::tests {

inline std::string read_text(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    std::stringstream text;
    text << file.rdbuf();
    return text.str();
}

inline void write_text(const std::filesystem::path& path, std::string_view text) {
    std::ofstream(path, std::ios::binary).write(text.data(), static_cast<std::streamsize>(text.size()));
}

/// How one start of the program ended.
struct Ended {
    int code = -1;  ///< 128 + signal where it crashed
    std::string output, error;

    [[nodiscard]] std::ptrdiff_t error_lines() const { return std::count(error.begin(), error.end(), '\n'); }
};

inline std::string quoted(const std::string& text) {
    std::string result = "'";
    for (const char c : text) result += c == '\'' ? "'\\''" : std::string(1, c);
    return result + "'";
}

/// A folder of its own for each test, gone afterwards, in which the program is started.
class ProgramTest : public testing::Test {
protected:
    void SetUp() override {
        const auto* info = testing::UnitTest::GetInstance()->current_test_info();
        std::string name = fmt::format("heliodon-{}-{}-{}", getpid(), info->test_suite_name(), info->name());
        std::replace(name.begin(), name.end(), '/', '-');
        folder_ = std::filesystem::temp_directory_path() / name;
        std::filesystem::create_directories(folder_);
    }
    void TearDown() override { std::filesystem::remove_all(folder_); }

    [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }
    void write(const std::string& name, std::string_view text) const { write_text(folder_ / name, text); }
    [[nodiscard]] bool exists(const std::string& name) const { return std::filesystem::exists(folder_ / name); }
    [[nodiscard]] std::vector<std::string> files() const {
        std::vector<std::string> names;
        for (const auto& entry : std::filesystem::recursive_directory_iterator(folder_))
            names.push_back(std::filesystem::relative(entry.path(), folder_).string());
        std::sort(names.begin(), names.end());
        return names;
    }

    /// Starts `heliodon ARGUMENTS` in the folder, by way of `launcher` (a shell command that takes a command).
    [[nodiscard]] Ended run(const std::vector<std::string>& arguments, const std::string& launcher = "") const {
        const std::filesystem::path output = folder_.string() + ".out", error = folder_.string() + ".err";
        std::string command = "cd " + quoted(folder_.string()) + " && " + launcher + " " + quoted(HELIODON_PROGRAM);
        for (const std::string& argument : arguments) command += " " + quoted(argument);
        const int status =
            std::system((command + " >" + quoted(output.string()) + " 2>" + quoted(error.string())).c_str());
        Ended ended{WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), read_text(output),
                    read_text(error)};
        std::filesystem::remove(output);
        std::filesystem::remove(error);
        return ended;
    }

private:
    std::filesystem::path folder_;
};

/// A floor lit by one lamp, with a sensor under it: E = I / d² = 400 / 4 = 100 lux.
inline constexpr std::string_view small_scene = R"({
  "heliodon": 1,
  "cameras": [{ "name": "main", "position": [0, 1, 3], "target": [0, 0.5, 0], "vertical_fov_deg": 40, "ev100": 5 },
              { "name": "above", "position": [0, 3, 0.01], "target": [0, 0, 0], "vertical_fov_deg": 40, "ev100": 6 }],
  "materials": { "white": { "model": "lambert", "base_color": [0.5, 0.5, 0.5] } },
  "nodes": [
    { "name": "floor", "shape": { "type": "quad", "origin": [-2, 0, -2], "u": [0, 0, 4], "v": [4, 0, 0] }, "material": "white" },
    { "name": "bulb", "light": { "type": "point", "intensity_cd": [400, 400, 400] }, "translate": [0, 2, 0] }
  ],
  "sensors": [{ "name": "under, the bulb", "type": "illuminance", "position": [0, 0, 0], "normal": [0, 1, 0] }],
  "render": { "gi": "none" }
})";

}  // namespace heliodon::tests
