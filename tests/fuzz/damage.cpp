#include "damage.h"

#include <algorithm>
#include <array>
#include <string_view>

namespace heliodon::tests {

using nlohmann::json;

std::string Damage::bytes(std::string text) {
    if (one_in(8)) {
        text.resize(pick(text.size()));
        return text;
    }
    constexpr std::array extremes{'\0', '\xff', '\x7f', '\x80', '\x01', '\x20'};
    for (std::size_t i = 1 + pick(3); i > 0 && !text.empty(); --i) {
        const std::size_t at = pick(one_in(2) ? std::min<std::size_t>(text.size(), 600) : text.size());
        switch (pick(7)) {
            case 0:
            case 5:
            case 6:
                text[at] = static_cast<char>(random_());
                break;
            case 1:
                text[at] = static_cast<char>(text[at] ^ (1 << pick(8)));
                break;
            case 2:
                std::fill_n(text.begin() + static_cast<std::ptrdiff_t>(at), std::min<std::size_t>(4, text.size() - at),
                            extremes[pick(extremes.size())]);
                break;
            case 3:
                text.erase(at, 1 + pick(16));
                break;
            default:
                text.insert(at, text.substr(pick(text.size()), 1 + pick(16)));
        }
    }
    return text;
}

json& Damage::somewhere(json& document) {
    json* at = &document;
    while (at->is_structured() && !at->empty() && !one_in(10)) {
        auto child = at->begin();
        std::advance(child, pick(at->size()));
        at = &*child;
    }
    return *at;
}

json Damage::odd_value(const json& old) {
    if (old.is_number() && one_in(2)) {
        const auto value = old.get<double>();
        const std::array<json, 9> near{old.is_number_integer() ? json(old.get<std::int64_t>() + 1) : json(value + 1),
                                       old.is_number_integer() ? json(old.get<std::int64_t>() - 1) : json(value - 1),
                                       json(-value),
                                       json(value * 1e6),
                                       json(value * 1e-6),
                                       json(value + 0.5),
                                       json(value * 3e38),
                                       json(4),
                                       json(0)};
        return near[pick(near.size())];
    }
    static const std::vector<json> odd{nullptr,
                                       true,
                                       false,
                                       0,
                                       -1,
                                       1,
                                       2,
                                       255,
                                       65536,
                                       2147483647,
                                       2147483648,
                                       -2147483648LL,
                                       4294967295,
                                       4294967296,
                                       9223372036854775807LL,
                                       -9223372036854775807LL,
                                       18446744073709551615ULL,
                                       0.5,
                                       -0.0,
                                       1e-45,
                                       1e-300,
                                       3e38,
                                       -3e38,
                                       1e39,
                                       1e308,
                                       -1e308,
                                       "",
                                       "x",
                                       ".",
                                       "..",
                                       "../../../../../../etc",
                                       "data:,",
                                       "data:application/octet-stream;base64,AAAA",
                                       "%00%ff%",
                                       std::string("\0\n\x1b[1m", 6),
                                       "SCALAR",
                                       "VEC2",
                                       "VEC4",
                                       "MAT4",
                                       "MASK",
                                       "BLEND",
                                       "CUBICSPLINE",
                                       "rotation",
                                       "perspective",
                                       json::array(),
                                       json::object(),
                                       json::array({nullptr}),
                                       {0, 0, 0},
                                       {0, 1},
                                       {1e38, 1e38, 1e38},
                                       {-1, 0, 1, 2, 3},
                                       {{"index", 0}},
                                       {{"index", 0}, {"texCoord", 1}},
                                       {{"x", json::array()}}};
    return odd[pick(odd.size())];
}

void Damage::damage_value(json& document) {
    json& value = somewhere(document);
    switch (pick(8)) {
        case 0:
            if (value.is_structured() && !value.empty()) {
                auto child = value.begin();
                std::advance(child, pick(value.size()));
                value.erase(child);
                return;
            }
            break;
        case 1:
            if (value.is_array() && !value.empty()) {
                const json repeated = value[pick(value.size())];
                value.push_back(repeated);
                return;
            }
            break;
        case 2: {
            const json other = somewhere(document);
            if (other.dump().size() < 100000) value = other;
            return;
        }
        default:
            break;
    }
    value = odd_value(value);
}

json Damage::values(json document) {
    for (std::size_t i = 1 + pick(3); i > 0; --i) damage_value(document);
    return document;
}

void Damage::damage_word(std::string& text) {
    static constexpr std::array<std::string_view, 40> odd{"0",
                                                          "-1",
                                                          "1",
                                                          "2",
                                                          "999999",
                                                          "-999999",
                                                          "2147483648",
                                                          "-2147483649",
                                                          "99999999999999999999",
                                                          "1e39",
                                                          "-1e39",
                                                          "1e999",
                                                          "nan",
                                                          "inf",
                                                          "-inf",
                                                          "1e-45",
                                                          "0x10",
                                                          "1/1/1",
                                                          "1//-5",
                                                          "-4/9",
                                                          "/",
                                                          "//",
                                                          "1/",
                                                          "v",
                                                          "vt",
                                                          "vn",
                                                          "f",
                                                          "o",
                                                          "g",
                                                          "s",
                                                          "usemtl",
                                                          "mtllib",
                                                          "newmtl",
                                                          "map_Kd",
                                                          "Kd",
                                                          "\\",
                                                          "\\\nv 0 0",
                                                          "#",
                                                          "\xff\xfe",
                                                          ""};
    const std::size_t at = text.find_first_not_of(" \n", pick(text.size()));
    if (at == std::string::npos) return;
    const std::size_t begin = text.find_last_of(" \n", at) + 1;
    const std::size_t end = std::min(text.find_first_of(" \n", at), text.size());
    const std::string word(odd[pick(odd.size())]);
    switch (pick(6)) {
        case 0:
            text.erase(begin, end - begin);
            break;
        case 1:
            text.insert(begin, word + " ");
            break;
        case 2:
            text.insert(begin, word + "\n");
            break;
        case 3: {
            const std::size_t line = text.rfind('\n', at) + 1;
            text.insert(line, text.substr(line, text.find('\n', at) - line) + "\n");
            break;
        }
        default:
            text.replace(begin, end - begin, word);
    }
}

std::string Damage::words(std::string text) {
    for (std::size_t i = 1 + pick(3); i > 0 && !text.empty(); --i) damage_word(text);
    return text;
}

}  // namespace heliodon::tests
