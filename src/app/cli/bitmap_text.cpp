#include "app/cli/bitmap_text.h"

#include <algorithm>
#include <array>
#include <cstring>

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include <stb_easy_font.h>
#pragma GCC diagnostic pop

namespace heliodon::cli {
namespace {

/// stb's functions take text that they may write to, but do not.
char* unowned(const std::string& text) {
    return const_cast<char*>(text.c_str());
}

struct Vertex {
    float x, y, z;
    unsigned char color[4];
};
static_assert(sizeof(Vertex) == 16, "as stb_easy_font writes it");

}  // namespace

void fill_rectangle(Image& image, glm::ivec2 low, glm::ivec2 high, const glm::vec3& color) {
    low = glm::max(low, glm::ivec2(0));
    high = glm::min(high, glm::ivec2(image.width, image.height));
    for (int y = low.y; y < high.y; ++y)
        for (int x = low.x; x < high.x; ++x)
            for (int c = 0; c < 3; ++c) image.at(x, y, c) = color[c];
}

glm::ivec2 text_size(const std::string& text) {
    return text_scale * glm::ivec2(stb_easy_font_width(unowned(text)), stb_easy_font_height(unowned(text)));
}

void draw_text(Image& image, glm::ivec2 at, const std::string& text, const glm::vec3& color) {
    constexpr std::size_t vertices_a_letter = 4 * 24;  // more dots in a row or column no letter has
    std::vector<Vertex> vertices((text.size() + 1) * vertices_a_letter);
    const int quads = stb_easy_font_print(0, 0, unowned(text), nullptr, vertices.data(), static_cast<int>(vertices.size() * sizeof(Vertex)));
    for (int quad = 0; quad < quads; ++quad) {
        const Vertex &low = vertices[4 * static_cast<std::size_t>(quad)], &high = vertices[4 * static_cast<std::size_t>(quad) + 2];
        fill_rectangle(image, at + text_scale * glm::ivec2(low.x, low.y), at + text_scale * glm::ivec2(high.x, high.y), color);
    }
}

}  // namespace heliodon::cli
