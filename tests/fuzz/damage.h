#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <random>
#include <string>

namespace heliodon::tests {

/// A seeded source of damage: the same seed damages the same way on every machine.
class Damage {
public:
    explicit Damage(std::uint64_t seed) : random_(seed) {}

    /// 0 … count − 1
    [[nodiscard]] std::size_t pick(std::size_t count) { return count == 0 ? 0 : random_() % count; }
    [[nodiscard]] bool one_in(std::size_t count) { return pick(count) == 0; }

    /// Cut off, or with a few bytes flipped, set to extremes, removed or repeated. Half of the time near the
    /// start, where headers are.
    [[nodiscard]] std::string bytes(std::string text);

    /// With one to three values replaced by odd ones, removed, repeated or swapped with another's.
    [[nodiscard]] nlohmann::json values(nlohmann::json document);

    /// With one to three words or lines of text replaced by odd ones, removed or repeated.
    [[nodiscard]] std::string words(std::string text);

private:
    nlohmann::json& somewhere(nlohmann::json& document);
    void damage_value(nlohmann::json& document);
    nlohmann::json odd_value(const nlohmann::json& old);
    void damage_word(std::string& text);

    std::mt19937_64 random_;
};

}  // namespace heliodon::tests
