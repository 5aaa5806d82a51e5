# Debian packages that Heliodon needs, by the same names on Debian 12 and 13. Sourced by setup.sh.

build_packages=(
    # compiler and build tools
    g++ cmake ninja-build ccache pkg-config python3
    # Vulkan, shaders
    libvulkan-dev libvulkan1 libvulkan-volk-dev glslang-dev glslang-tools
    libspirv-cross-c-shared-dev spirv-tools spirv-headers
    # window and overlay
    libglfw3-dev libimgui-dev
    # mathematics, rays, threads
    libglm-dev libembree-dev libtbb-dev
    # pictures and models
    libopenexr-dev libstb-dev libtinyobjloader-dev libtinygltf-dev libmeshoptimizer-dev libdraco-dev
    # where the sun stands
    liberfa-dev
    # the rest
    nlohmann-json3-dev libcli11-dev libfmt-dev libexpected-dev libgtest-dev libbenchmark-dev
    # a Vulkan device where there is no GPU (lavapipe)
    mesa-vulkan-drivers
)

# Only the tests need these.
test_packages=(vulkan-validationlayers xvfb xauth xdotool imagemagick)

# lavapipe has descriptor indexing, which the renderer needs, from this Mesa on. Older: taken from backports.
mesa_minimum=25
