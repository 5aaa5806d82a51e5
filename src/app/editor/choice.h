#pragma once

#include <imgui.h>

namespace heliodon::editor {

/// One of the values of an enumeration, numbered from 0; `names` in that order, each ended by a zero.
template <class Enumeration>
bool named_choice(const char* label, Enumeration& value, const char* names) {
    int index = static_cast<int>(value);
    if (!ImGui::Combo(label, &index, names)) return false;
    value = static_cast<Enumeration>(index);
    return true;
}

}  // namespace heliodon::editor
