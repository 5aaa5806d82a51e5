#include "app/editor/viewer.h"

#include <imgui.h>
#include <backends/imgui_impl_glfw.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>

#include "app/editor/camera_control.h"
#include "app/editor/overlay/overlay.h"
#include "app/editor/panels.h"
#include "app/editor/window.h"
#include "gpu/swapchain.h"
#include "heliodon_editor_shaders.h"
#include "realtime/live.h"

// GLFW declares it only where Vulkan's own header came first; volk's does not count.
extern "C" PFN_vkVoidFunction glfwGetInstanceProcAddress(VkInstance, const char*);

namespace heliodon::editor {
namespace {

/// Dear ImGui's context, fed by a window's events.
class Interface {
public:
    explicit Interface(GLFWwindow* window) {
        IMGUI_CHECKVERSION();
        ImGui::CreateContext();
        ImGui::GetIO().IniFilename = nullptr;  // writes no file beside the user's work
        ImGui::StyleColorsDark();
        ImGui_ImplGlfw_InitForOther(window, true);
    }
    ~Interface() {
        ImGui_ImplGlfw_Shutdown();
        ImGui::DestroyContext();
    }
    Interface(const Interface&) = delete;
    Interface& operator=(const Interface&) = delete;

    void begin_frame() const {
        ImGui_ImplGlfw_NewFrame();
        ImGui::NewFrame();
    }
};

struct DestroySurface {
    VkInstance instance = VK_NULL_HANDLE;
    void operator()(VkSurfaceKHR_T* surface) const {
        // The library keeps its Vulkan entry points to itself: exported, they would stand in for the loader's own.
        const auto destroy =
            reinterpret_cast<PFN_vkDestroySurfaceKHR>(glfwGetInstanceProcAddress(instance, "vkDestroySurfaceKHR"));
        destroy(instance, surface, nullptr);
    }
};
using Surface = std::unique_ptr<VkSurfaceKHR_T, DestroySurface>;

/// Everything the window needs, in the order it is made; destroyed the other way round.
struct Viewer {
    Window window;
    std::shared_ptr<gpu::Instance> instance;
    Surface surface;
    std::unique_ptr<gpu::Device> device;
    gpu::Swapchain swapchain;
    std::unique_ptr<Interface> interface;
    std::optional<LiveRenderer> renderer;
    std::optional<Overlay> overlay;
};

Result<Viewer> open(const ViewerSettings& settings) {
    auto window = Window::create("Heliodon", settings.width, settings.height);
    if (!window) return tl::unexpected(window.error());
    Viewer viewer{.window = std::move(*window)};
    auto instance = gpu::Instance::create({settings.validation, viewer.window.instance_extensions()});
    if (!instance) return tl::unexpected(instance.error());
    viewer.instance = *instance;
    const auto surface = viewer.window.create_surface(viewer.instance->handle());
    if (!surface) return tl::unexpected(surface.error());
    viewer.surface = Surface(*surface, {viewer.instance->handle()});
    auto device = gpu::Device::create(viewer.instance, {.device = settings.device, .swapchain = true});
    if (!device) return tl::unexpected(device.error());
    viewer.device = std::move(*device);
    auto swapchain = gpu::Swapchain::create(*viewer.device, *surface, viewer.window.extent());
    if (!swapchain) return tl::unexpected(swapchain.error());
    viewer.swapchain = std::move(*swapchain);
    viewer.interface = std::make_unique<Interface>(viewer.window.handle());
    auto renderer = LiveRenderer::create(*viewer.device, settings.shader_directory);
    if (!renderer) return tl::unexpected(renderer.error());
    viewer.renderer = std::move(*renderer);
    gpu::Pipelines& pipelines = viewer.renderer->pipelines();
    pipelines.shaders().add(embedded_shaders());
    auto overlay = Overlay::create(*viewer.device, pipelines, viewer.swapchain.format());
    if (!overlay) return tl::unexpected(overlay.error());
    viewer.overlay = std::move(*overlay);
    return viewer;
}

void move_camera(ViewState& view, const Input& input, float height, float seconds) {
    const ImGuiIO& io = ImGui::GetIO();
    const auto [left, right, middle] = input.drags;
    if (!io.WantCaptureMouse) {
        if (left != glm::vec2(0)) view.camera = view.fly ? look(view.camera, left, height) : orbit(view.camera, left, height);
        if (right != glm::vec2(0)) view.camera = look(view.camera, right, height);
        if (middle != glm::vec2(0)) view.camera = pan(view.camera, middle, height);
        if (input.scroll != 0) view.camera = dolly(view.camera, input.scroll);
    }
    if (!io.WantCaptureKeyboard && input.keys != glm::vec3(0))
        view.camera = fly(view.camera, input.keys * view.fly_speed_m_per_s * seconds);
}

constexpr gpu::Access blit_source{VK_PIPELINE_STAGE_2_BLIT_BIT, VK_ACCESS_2_TRANSFER_READ_BIT, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL};
constexpr gpu::Access blit_target{VK_PIPELINE_STAGE_2_BLIT_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL};
constexpr gpu::Access color_target{VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
                                   VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT,
                                   VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
constexpr gpu::Access presented{VK_PIPELINE_STAGE_2_BOTTOM_OF_PIPE_BIT, VK_ACCESS_2_NONE, VK_IMAGE_LAYOUT_PRESENT_SRC_KHR};

/// Renders the scene, copies it to the window's image, draws the overlay on top and shows it.
Result<void> show_frame(Viewer& viewer, const Scene& scene, const ViewState& view, const gpu::Swapchain::Frame& frame,
                        float seconds, int& accumulated_frames) {
    auto commands = viewer.device->begin_commands("live frame");
    if (!commands) return tl::unexpected(commands.error());
    const VkExtent2D extent = viewer.swapchain.extent();
    const auto live = viewer.renderer->render(scene, view.camera, static_cast<int>(extent.width), static_cast<int>(extent.height), true, seconds);
    if (!live) return tl::unexpected(live.error());
    accumulated_frames = live->accumulated_frames;
    commands->transition(*live->image, blit_source);
    // The image was acquired anew: whatever it held before is gone, but its acquisition must be waited for.
    frame.image->set_state({VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_NONE, VK_IMAGE_LAYOUT_UNDEFINED});
    commands->transition(*frame.image, blit_target);
    commands->blit({live->image}, {frame.image}, VK_FILTER_NEAREST);
    commands->transition(*frame.image, color_target);
    if (auto drawn = viewer.overlay->record(*commands, *ImGui::GetDrawData(), *frame.image); !drawn) return drawn;
    commands->transition(*frame.image, presented);
    const gpu::SubmitSemaphores semaphores{.wait = frame.acquired, .signal = frame.finished};
    const auto submitted = viewer.device->submit(std::move(*commands), semaphores);
    if (!submitted) return tl::unexpected(submitted.error());
    const auto shown = viewer.swapchain.present(frame);
    if (!shown) return tl::unexpected(shown.error());
    return *shown ? Result<void>{} : viewer.swapchain.resize(viewer.window.extent());
}

Result<void> run(Viewer& viewer, Scene& scene, ViewState& view) {
    using Clock = std::chrono::steady_clock;
    auto last = Clock::now();
    int accumulated_frames = 0;
    std::vector<Error> shader_errors;
    while (!viewer.window.should_close()) {
        const VkExtent2D size = viewer.window.extent();
        const bool minimized = size.width == 0 || size.height == 0;
        const Input input = viewer.window.poll(minimized);
        if (minimized) continue;
        const auto now = Clock::now();
        const float seconds = std::chrono::duration<float>(now - last).count();
        last = now;

        viewer.interface->begin_frame();
        move_camera(view, input, static_cast<float>(size.height), seconds);
        if (input.toggle_panels) view.panels_visible = !view.panels_visible;
        // Shaders that do not compile stay as they were; the panel shows why.
        if (input.reload_shaders) {
            shader_errors.clear();
            if (auto reloaded = viewer.renderer->reload_shaders(); !reloaded) shader_errors.push_back(reloaded.error());
        }
        const std::vector<PassTime> passes = viewer.renderer->pass_times();
        FrameReport report{passes, 0, viewer.device->info().name, accumulated_frames, shader_errors};
        for (const PassTime& pass : passes) report.gpu_ms_total += pass.gpu_ms;
        draw_panels(scene, view, report);
        ImGui::Render();

        const auto frame = viewer.swapchain.acquire();
        if (!frame) return tl::unexpected(frame.error());
        if (!*frame) {
            if (auto resized = viewer.swapchain.resize(viewer.window.extent()); !resized) return resized;
            continue;
        }
        if (auto shown = show_frame(viewer, scene, view, **frame, seconds, accumulated_frames); !shown) return shown;
    }
    return viewer.device->wait_idle();
}

Result<Camera> first_camera(const Scene& scene, const std::string& name) {
    std::optional<Camera> found;
    scene.cameras().each([&](CameraId, const Camera& camera) {
        if (!found && (name.empty() || camera.name == name)) found = camera;
    });
    if (found) return *found;
    return name.empty() ? Result<Camera>(Camera{}) : fail("--camera", "the scene has no camera \"" + name + "\"");
}

}  // namespace

Result<void> view(Scene scene, const ViewerSettings& settings) {
    const auto camera = first_camera(scene, settings.camera);
    if (!camera) return tl::unexpected(camera.error());
    auto viewer = open(settings);
    if (!viewer) return tl::unexpected(viewer.error());
    ViewState state{.camera = *camera};
    state.fly_speed_m_per_s = std::max(0.5f, 0.2f * scene.bounds().diagonal());
    if (auto ran = run(*viewer, scene, state); !ran) return ran;
    const auto messages = viewer->device->validation_messages();
    return messages.empty() ? Result<void>{} : fail("validation", messages.front());
}

}  // namespace heliodon::editor
