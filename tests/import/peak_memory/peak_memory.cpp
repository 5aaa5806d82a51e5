// Loads one model and prints the bytes of what it decoded and the process's peak resident memory, both in
// bytes: a process of its own, because the peak of a test process is that of its greediest test.
#include <fstream>
#include <iostream>
#include <string>

#include "import/import.h"

namespace {

std::size_t peak_resident_bytes() {
    std::ifstream status("/proc/self/status");
    for (std::string line; std::getline(status, line);)
        if (line.starts_with("VmHWM:")) return std::stoull(line.substr(6)) * 1024;
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 2) return 2;
    heliodon::Warnings warnings;
    const auto scene = heliodon::load_scene(argv[1], {}, warnings);
    if (!scene) {
        std::cerr << scene.error().text() << "\n";
        return 1;
    }
    std::size_t decoded = 0;
    scene->geometries().each([&](auto, const heliodon::Geometry& geometry) { decoded += geometry.mesh.bytes(); });
    scene->textures().each([&](auto, const heliodon::Texture& texture) { decoded += texture.bytes(); });
    std::cout << decoded << " " << peak_resident_bytes() << "\n";
}
