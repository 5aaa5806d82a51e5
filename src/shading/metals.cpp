#include "shading/metals.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

#include "shading/colour_matching.h"
#include "shading/fresnel.h"

namespace heliodon::shading {
namespace {

struct Index {
    double nm, n, k;
};
struct NK {
    double n, k;
};

// n and k of the noble metals and aluminium at photon energies from 3.3 to 1.55 eV in steps of 0.05 eV: the collection of
// luxpop.com (after Palik 1985, Handbook of Optical Constants of Solids), which Mitsuba and pbrt carry too.
constexpr double first_ev = 3.3, step_ev = -0.05, ev_nm = 1239.8417;
using Tabulated = std::array<NK, 36>;
constexpr Tabulated gold{{
    {1.696, 1.906}, {1.68475, 1.9225}, {1.674, 1.936}, {1.666, 1.94775}, {1.658, 1.956}, {1.64725, 1.95938},
    {1.636, 1.958}, {1.628, 1.95138}, {1.616, 1.94}, {1.59625, 1.9245}, {1.562, 1.904}, {1.50212, 1.87587},
    {1.426, 1.846}, {1.34587, 1.81462}, {1.242, 1.796}, {1.08675, 1.79737}, {0.916, 1.84}, {0.7545, 1.9565},
    {0.608, 2.12}, {0.49175, 2.32625}, {0.402, 2.54}, {0.3455, 2.73062}, {0.306, 2.88}, {0.267625, 2.94062},
    {0.236, 2.97}, {0.212375, 3.015}, {0.194, 3.06}, {0.17775, 3.07}, {0.166, 3.15}, {0.161, 3.44581},
    {0.16, 3.8}, {0.160875, 4.08769}, {0.164, 4.357}, {0.1695, 4.61019}, {0.176, 4.86}, {0.181375, 5.12581},
}};
constexpr Tabulated copper{{
    {1.225, 2.015}, {1.2, 2.12156}, {1.18, 2.21}, {1.17437, 2.17719}, {1.175, 2.13}, {1.1775, 2.16006},
    {1.18, 2.21}, {1.17813, 2.24994}, {1.175, 2.289}, {1.17281, 2.326}, {1.17, 2.362}, {1.16531, 2.39763},
    {1.16, 2.433}, {1.15531, 2.46919}, {1.15, 2.504}, {1.14281, 2.53587}, {1.135, 2.564}, {1.13156, 2.58962},
    {1.12, 2.605}, {1.09244, 2.59556}, {1.04, 2.583}, {0.950375, 2.5765}, {0.826, 2.599}, {0.645875, 2.67806},
    {0.468, 2.809}, {0.35125, 3.01075}, {0.272, 3.24}, {0.230813, 3.45819}, {0.214, 3.67}, {0.20925, 3.86313},
    {0.213, 4.05}, {0.21625, 4.23956}, {0.223, 4.43}, {0.2365, 4.61956}, {0.25, 4.817}, {0.254188, 5.03413},
}};
constexpr Tabulated aluminium{{
    {0.432, 4.56}, {0.445688, 4.63375}, {0.46, 4.71}, {0.474688, 4.78437}, {0.49, 4.86}, {0.506188, 4.93813},
    {0.523, 5.02}, {0.540063, 5.10875}, {0.558, 5.2}, {0.577313, 5.29}, {0.598, 5.38}, {0.620313, 5.48},
    {0.644, 5.58}, {0.668625, 5.69}, {0.695, 5.8}, {0.72375, 5.915}, {0.755, 6.03}, {0.789, 6.15},
    {0.826, 6.28}, {0.867, 6.42}, {0.912, 6.55}, {0.963, 6.7}, {1.02, 6.85}, {1.08, 7},
    {1.15, 7.15}, {1.22, 7.31}, {1.3, 7.48}, {1.39, 7.65}, {1.49, 7.82}, {1.6, 8.01},
    {1.74, 8.21}, {1.91, 8.39}, {2.14, 8.57}, {2.41, 8.62}, {2.63, 8.6}, {2.8, 8.45},
}};
constexpr Tabulated silver{{
    {0.2, 1.67}, {0.198063, 1.735}, {0.192, 1.81}, {0.182, 1.87875}, {0.173, 1.95}, {0.172625, 2.02937},
    {0.173, 2.11}, {0.166688, 2.18625}, {0.16, 2.26}, {0.1585, 2.32938}, {0.157, 2.4}, {0.151063, 2.47875},
    {0.144, 2.56}, {0.137313, 2.64}, {0.132, 2.72}, {0.13025, 2.79813}, {0.13, 2.88}, {0.129938, 2.97375},
    {0.13, 3.07}, {0.130063, 3.15937}, {0.129, 3.25}, {0.124375, 3.34813}, {0.12, 3.45}, {0.119313, 3.55375},
    {0.121, 3.66}, {0.1255, 3.76625}, {0.131, 3.88}, {0.136125, 4.01063}, {0.14, 4.15}, {0.140063, 4.29312},
    {0.14, 4.44}, {0.144313, 4.58625}, {0.148, 4.74}, {0.145875, 4.90813}, {0.143, 5.09}, {0.142563, 5.28875},
}};

// By wavelength in nm: Johnson & Christy 1974, "Optical constants of transition metals", through refractiveindex.info (CC0).
using Listed = std::array<Index, 16>;
constexpr Listed iron{{
    {368, 2.02, 2.43}, {381, 2.12, 2.5}, {397, 2.24, 2.58}, {413, 2.35, 2.65},
    {431, 2.48, 2.71}, {451, 2.59, 2.77}, {471, 2.67, 2.82}, {496, 2.74, 2.88},
    {521, 2.86, 2.91}, {549, 2.95, 2.93}, {582, 2.94, 2.99}, {617, 2.88, 3.05},
    {659, 2.92, 3.1}, {704, 2.86, 3.19}, {756, 2.87, 3.28}, {821, 2.94, 3.39},
}};
constexpr Listed chromium{{
    {368, 1.87, 2.69}, {381, 1.92, 2.74}, {397, 2, 2.83}, {413, 2.08, 2.93},
    {431, 2.19, 3.04}, {451, 2.33, 3.14}, {471, 2.51, 3.24}, {496, 2.75, 3.3},
    {521, 2.94, 3.33}, {549, 3.18, 3.33}, {582, 3.22, 3.3}, {617, 3.17, 3.3},
    {659, 3.09, 3.34}, {704, 3.05, 3.39}, {756, 3.08, 3.42}, {821, 3.2, 3.48},
}};

NK between(const Index& a, const Index& b, double nm) {
    const double part = (nm - a.nm) / (b.nm - a.nm);
    return {std::lerp(a.n, b.n, part), std::lerp(a.k, b.k, part)};
}
NK index_at(const Tabulated& table, double nm) {
    const double row = (ev_nm / nm - first_ev) / step_ev;
    const std::size_t i = std::min(static_cast<std::size_t>(std::max(row, 0.0)), table.size() - 2);
    const auto entry = [&](std::size_t j) { return Index{ev_nm / (first_ev + step_ev * static_cast<double>(j)), table[j].n, table[j].k}; };
    return between(entry(i), entry(i + 1), nm);
}
NK index_at(const Listed& table, double nm) {
    std::size_t i = 0;
    while (i + 2 < table.size() && table[i + 1].nm < nm) ++i;
    return between(table[i], table[i + 1], nm);
}
NK index_of(Metal metal, double nm) {
    switch (metal) {
        case Metal::gold: return index_at(gold, nm);
        case Metal::silver: return index_at(silver, nm);
        case Metal::copper: return index_at(copper, nm);
        case Metal::aluminium: return index_at(aluminium, nm);
        case Metal::iron: return index_at(iron, nm);
        case Metal::chromium: return index_at(chromium, nm);
    }
    return {1, 0};
}

/// Where a grazing view tells metals of one colour apart: cos 82° (Hoffman 2019, "Fresnel Equations Considered Harmful").
constexpr double grazing_cosine = 1.0 / 7;

/// The n, with the k that gives it normal reflectance `r0`, whose reflectance at grazing_cosine is nearest to `grazing`.
/// Gulbrandsen 2014, "Artist Friendly Metallic Fresnel", eq. 5 and 6, for what n and k such an r0 allows.
glm::vec2 indices_of(double r0, double grazing) {
    const double r = std::clamp(r0, 0.0, 0.9999), root = std::sqrt(r);
    const double low = (1 - r) / (1 + r), high = (1 + root) / (1 - root);
    constexpr int steps = 2048;
    glm::vec2 best(1, 0);
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i <= steps; ++i) {
        const double n = low * std::pow(high / low, static_cast<double>(i) / steps);
        const double k = std::sqrt(std::max(0.0, (r * (n + 1) * (n + 1) - (n - 1) * (n - 1)) / (1 - r)));
        const glm::vec2 indices(n, k);
        const double miss = std::abs(fresnel_conductor(static_cast<float>(grazing_cosine), indices.x, indices.y) - grazing);
        if (miss >= least) continue;
        least = miss;
        best = indices;
    }
    return best;
}

}  // namespace

glm::dvec3 reflectance_to_rgb(const std::function<double(double nm)>& reflectance) {
    glm::dvec3 sum(0), white(0);
    for (std::size_t i = 0; i < colour_matching.size(); ++i) {
        const ColourMatching& c = colour_matching[i];
        const glm::dvec3 light = c.d65 * glm::dvec3(c.x, c.y, c.z);
        white += light;
        sum += light * reflectance(first_nm + step_nm * static_cast<double>(i));
    }
    // IEC 61966-2-1:1999, XYZ to linear sRGB.
    const auto rgb = [](const glm::dvec3& xyz) {
        return glm::dvec3(3.2404542 * xyz.x - 1.5371385 * xyz.y - 0.4985314 * xyz.z,
                          -0.9692660 * xyz.x + 1.8760108 * xyz.y + 0.0415560 * xyz.z,
                          0.0556434 * xyz.x - 0.2040259 * xyz.y + 1.0572252 * xyz.z);
    };
    return rgb(sum) / rgb(white);
}

glm::dvec3 metal_reflectance(Metal metal, double cosine) {
    return reflectance_to_rgb([&](double nm) {
        const NK index = index_of(metal, nm);
        return fresnel_conductor(static_cast<float>(cosine), static_cast<float>(index.n), static_cast<float>(index.k));
    });
}

ConductorIndices metal_indices(Metal metal) {
    const glm::dvec3 normal = metal_reflectance(metal, 1), grazing = metal_reflectance(metal, grazing_cosine);
    ConductorIndices result;
    for (int c = 0; c < 3; ++c) {
        const glm::vec2 indices = indices_of(normal[c], grazing[c]);
        result.eta[c] = indices.x;
        result.k[c] = indices.y;
    }
    return result;
}

}  // namespace heliodon::shading
