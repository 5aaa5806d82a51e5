#pragma once

#include <string>

#include "core/image.h"

namespace heliodon::cli {

/// Letters are drawn this many pixels to a dot.
inline constexpr int text_scale = 2;

/// Size in pixels of a line of ASCII.
[[nodiscard]] glm::ivec2 text_size(const std::string& text);
/// Draws it with its top left corner at `at`; what lies outside the picture is left out.
void draw_text(Image& image, glm::ivec2 at, const std::string& text, const glm::vec3& color);
void fill_rectangle(Image& image, glm::ivec2 low, glm::ivec2 high, const glm::vec3& color);

}  // namespace heliodon::cli
