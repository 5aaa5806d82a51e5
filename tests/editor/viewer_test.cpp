#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "core/image_io.h"

namespace heliodon::editor {
namespace {

using namespace std::chrono_literals;

/// A child process that is ended with its test.
class Process {
public:
    Process(std::vector<std::string> arguments, const std::string& log, int inherited = -1) : pid_(fork()) {
        if (pid_ != 0) return;
        const int file = open(log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
        dup2(file, STDOUT_FILENO);
        dup2(file, STDERR_FILENO);
        if (inherited >= 0) fcntl(inherited, F_SETFD, 0);
        std::vector<char*> pointers;
        for (std::string& argument : arguments) pointers.push_back(argument.data());
        pointers.push_back(nullptr);
        execvp(pointers[0], pointers.data());
        _exit(127);
    }
    ~Process() {
        if (ended_) return;
        kill(pid_, SIGKILL);
        waitpid(pid_, nullptr, 0);
    }
    Process(const Process&) = delete;
    Process& operator=(const Process&) = delete;

    /// The exit code, or −1 when it is still running after `limit`.
    int wait_for_exit(std::chrono::seconds limit) {
        for (const auto end = std::chrono::steady_clock::now() + limit; std::chrono::steady_clock::now() < end;) {
            int status = 0;
            if (waitpid(pid_, &status, WNOHANG) == pid_) {
                ended_ = true;
                return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
            }
            std::this_thread::sleep_for(50ms);
        }
        return -1;
    }

private:
    pid_t pid_;
    bool ended_ = false;
};

// Where things stand in the window, in pixels from its top left; the panel's layout is the same at every start.
constexpr int width = 700, height = 560;
struct Point {
    int x, y;
};
constexpr Point red_intensity{70, 296}, white_material{58, 379}, white_green{125, 399}, exposure{105, 210}, cones{29, 422};

/// A desktop of its own (Xvfb) with the program's window, a person's hand (xdotool) and eye (a screenshot).
class ViewerTest : public testing::Test {
protected:
    void SetUp() override {
        if (std::system("command -v Xvfb xdotool import >/dev/null 2>&1") != 0) {
            if (std::getenv("CI")) FAIL() << "Xvfb, xdotool and ImageMagick are needed";
            GTEST_SKIP() << "needs Xvfb, xdotool and ImageMagick";
        }
        folder_ = std::filesystem::temp_directory_path() / ("heliodon-viewer-" + std::to_string(getpid()));
        std::filesystem::create_directories(folder_);
        std::ofstream(folder_ / "scene.heliodon.json") << R"({
          "heliodon": 1,
          "cameras": [{ "name": "main", "position": [0, 1, 3], "target": [0, 0.5, 0], "vertical_fov_deg": 40, "ev100": 5 }],
          "materials": { "white": { "model": "lambert", "base_color": [0.5, 0.5, 0.5] } },
          "nodes": [
            { "name": "floor", "shape": { "type": "quad", "origin": [-2, 0, -2], "u": [0, 0, 4], "v": [4, 0, 0] }, "material": "white" },
            { "name": "post", "shape": { "type": "box", "min": [-0.3, 0, -0.3], "max": [0.3, 0.6, 0.3] }, "material": "white" },
            { "name": "bulb", "light": { "type": "point", "intensity_cd": [100, 100, 100] }, "translate": [1, 2, 1] }
          ]
        })";
        start_desktop();
        viewer_ = std::make_unique<Process>(
            std::vector<std::string>{HELIODON_PROGRAM, "view", (folder_ / "scene.heliodon.json").string(), "--size",
                                     std::to_string(width) + "x" + std::to_string(height), "--validation"},
            folder_ / "viewer.log");
        ASSERT_TRUE(eventually([&] { return brightness(look()).y > 0.01f; })) << "no picture appeared: " << log();
    }
    void TearDown() override {
        viewer_.reset();
        desktop_.reset();
        std::filesystem::remove_all(folder_);
    }

    /// Xvfb writes the number of the display it took to a pipe.
    void start_desktop() {
        int ends[2];
        ASSERT_EQ(pipe2(ends, O_CLOEXEC), 0);
        desktop_ = std::make_unique<Process>(
            std::vector<std::string>{"Xvfb", "-displayfd", std::to_string(ends[1]), "-screen", "0", "1024x768x24", "-nolisten", "tcp"},
            folder_ / "desktop.log", ends[1]);
        close(ends[1]);
        std::string number;
        for (char c = 0; read(ends[0], &c, 1) == 1 && c != '\n';) number += c;
        close(ends[0]);
        ASSERT_FALSE(number.empty()) << "Xvfb did not start";
        setenv("DISPLAY", (":" + number).c_str(), 1);
    }

    void hand(const std::string& gestures) const { ASSERT_EQ(std::system(("xdotool " + gestures).c_str()), 0); }
    /// Presses at `from`, moves in steps as a hand does, releases.
    void drag(Point from, Point by) const {
        const auto at = [&](int quarter) {
            return "mousemove " + std::to_string(from.x + by.x * quarter / 4) + " " + std::to_string(from.y + by.y * quarter / 4);
        };
        hand(at(0) + " sleep 0.3 mousedown 1 sleep 0.3 " + at(1) + " sleep 0.2 " + at(2) + " sleep 0.2 " + at(3) + " sleep 0.2 " + at(4) +
             " sleep 0.4 mouseup 1");
    }
    [[nodiscard]] Image look() const {
        const std::string file = folder_ / "screen.png";
        const std::string command = "import -window root -crop " + std::to_string(width) + "x" + std::to_string(height) + "+0+0 +repage " + file;
        if (std::system(command.c_str()) != 0) return {};
        auto picture = read_picture(file);
        return picture ? std::move(picture->image) : Image{};
    }
    /// Mean of the part of the window that no panel covers: the floor at its bottom right.
    static glm::vec3 brightness(const Image& screen) {
        glm::vec3 sum(0);
        if (screen.width < width || screen.height < height) return sum;
        int count = 0;
        for (int y = 380; y < height - 10; ++y)
            for (int x = 400; x < width - 10; ++x, ++count) sum += screen.rgb(x, y);
        return sum / static_cast<float>(count);
    }
    static float difference(const Image& a, const Image& b) {
        if (a.pixels.size() != b.pixels.size()) return 1.0f;
        double sum = 0;
        for (std::size_t i = 0; i < a.pixels.size(); ++i) sum += std::abs(a.pixels[i] - b.pixels[i]);
        return static_cast<float>(sum / static_cast<double>(a.pixels.size()));
    }
    static bool eventually(const std::function<bool()>& condition) {
        for (const auto end = std::chrono::steady_clock::now() + 30s; std::chrono::steady_clock::now() < end;) {
            if (condition()) return true;
            std::this_thread::sleep_for(200ms);
        }
        return false;
    }
    [[nodiscard]] std::string log() const {
        std::ifstream file(folder_ / "viewer.log");
        return {std::istreambuf_iterator<char>(file), {}};
    }

    std::filesystem::path folder_;
    std::unique_ptr<Process> desktop_, viewer_;
};

TEST_F(ViewerTest, orbits_edits_lights_materials_and_exposure_resizes_and_closes) {
    const Image first = look();
    EXPECT_NEAR(brightness(first).x, brightness(first).y, 0.01f);

    drag({500, 300}, {90, 20});
    Image orbited;
    EXPECT_TRUE(eventually([&] { return difference(first, orbited = look()) > 0.005f; })) << "a drag orbits the camera";

    drag(red_intensity, {240, 0});
    Image reddened;
    EXPECT_TRUE(eventually([&] { return brightness(reddened = look()).x > 1.3f * brightness(orbited).x; })) << "the lamp turns red";
    EXPECT_NEAR(brightness(reddened).y, brightness(orbited).y, 0.02f);

    hand("mousemove " + std::to_string(white_material.x) + " " + std::to_string(white_material.y) + " sleep 0.3 click 1 sleep 0.5");
    drag(white_green, {-110, 0});
    Image purple;
    EXPECT_TRUE(eventually([&] { return brightness(purple = look()).y < 0.7f * brightness(reddened).y; })) << "the material loses its green";

    drag(exposure, {70, 0});
    EXPECT_TRUE(eventually([&] { return brightness(look()).x < 0.5f * brightness(purple).x; })) << "a higher EV100 darkens the picture";

    const Image panels = look();
    hand("key Tab");
    EXPECT_TRUE(eventually([&] { return difference(panels, look()) > 0.005f; })) << "Tab hides the panels";

    hand("search --name Heliodon windowsize 640 480");
    EXPECT_TRUE(eventually([&] { return look().rgb(width - 5, height - 5) == glm::vec3(0); })) << "the window shrinks";

    hand("key Escape");
    EXPECT_EQ(viewer_->wait_for_exit(20s), 0) << log();
    EXPECT_EQ(log(), "") << "no validation message, no warning";
}

TEST_F(ViewerTest, switches_voxel_cone_tracing_on_and_off_again) {
    const Image direct = look();
    const auto toggle = [] { return "mousemove " + std::to_string(cones.x) + " " + std::to_string(cones.y) + " sleep 0.3 click 1"; };
    hand(toggle());
    EXPECT_TRUE(eventually([&] { return brightness(look()).y > 1.01f * brightness(direct).y; })) << "the post lights the floor: " << log();
    hand(toggle());
    EXPECT_TRUE(eventually([&] { return std::abs(brightness(look()).y - brightness(direct).y) < 0.002f; })) << log();
    hand("key Escape");
    EXPECT_EQ(viewer_->wait_for_exit(20s), 0) << log();
    EXPECT_EQ(log(), "") << "no validation message, no warning";
}

}  // namespace
}  // namespace heliodon::editor
