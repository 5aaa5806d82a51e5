// What cones go past: how many levels are empty about each voxel, against the texture itself.
#include "gi_live.h"
#include "passes/occupancy/occupancy_shared.h"
#include "scene/procedural.h"

namespace heliodon::tests {
namespace {

/// The covers of the volume's texture.
struct Covers {
    glm::ivec3 extent;  // of level 0
    int size;           // voxels an edge of a cascade
    std::vector<std::vector<std::uint16_t>> levels;

    [[nodiscard]] bool covers(int cascade, int level, glm::ivec3 texel, int face) const {
        const int edge = size >> level;
        if (glm::any(glm::lessThan(texel, glm::ivec3(0))) || glm::any(glm::greaterThanEqual(texel, glm::ivec3(edge)))) return false;
        const glm::ivec3 at = texel + edge * glm::ivec3(face & 1, cascade, face >> 1), wide = extent >> level;
        return (levels[level][4 * static_cast<std::size_t>(at.x + wide.x * (at.y + wide.y * at.z)) + 3] & 0x7fff) != 0;  // −0 covers nothing
    }
    /// Whether a look in a texel can find the face: linear interpolation mixes in the texels beside it across the axis.
    [[nodiscard]] bool shows(int cascade, int level, glm::ivec3 texel, int face) const {
        const int axis = face / 2;
        for (int i = -1; i <= 1; ++i)
            for (int j = -1; j <= 1; ++j) {
                glm::ivec3 beside = texel;
                beside[(axis + 1) % 3] += i;
                beside[(axis + 2) % 3] += j;
                if (covers(cascade, level, beside, face)) return true;
            }
        return false;
    }
};

class GiOccupancy : public LiveFrames {
protected:
    void SetUp() override {
        LiveFrames::SetUp();
        const MaterialId grey = scene.add_material(lambert(glm::vec3(0.5f)));
        add_room(scene, {-2, 0, -1}, {2, 2, 1}, grey);
        add_shape_node(scene, Box{glm::vec3(-0.2f), glm::vec3(0.2f)}, grey,
                       {.translation = {-0.6f, 0.7f, -0.3f}, .rotation = rotation_from_euler_deg({20, 35, 10})});
        add_shape_node(scene, Sphere{{0.9f, 1.2f, 0.1f}, 0.3f}, grey);
        add_point_light(scene, {0, 1.5f, 0}, glm::vec3(20));
        camera.position = {-0.4f, 1, 0.9f};
        camera.target = {0, 0.8f, 0};
    }
    Covers covers_of(const Renderer& renderer, int size) {
        const gpu::Image& faces = *renderer->voxels().inputs().faces;
        Covers result{{faces.description().extent.width, faces.description().extent.height, faces.description().extent.depth}, size, {}};
        for (std::uint32_t level = 0; level < shading::occupancy_levels(size); ++level)
            result.levels.push_back(device->read_back_as<std::uint16_t>(faces, level).value());
        return result;
    }
    /// Levels about a voxel that do not show the face, from its own to the first that does.
    static int empty_levels(const Renderer& renderer, const Covers& covers, int cascade, glm::ivec3 voxel, int face) {
        const int last = covers.extent.y / covers.size - 1;
        int count = 0;
        for (; cascade < last; ++cascade, ++count) {
            if (covers.shows(cascade, 0, voxel, face)) return count;
            const auto base = [&](int c) { return renderer->voxels().surfaces(c).grid.base; };
            voxel = (voxel + base(cascade) >> 1) - base(cascade + 1);
        }
        for (int level = 0; level < static_cast<int>(covers.levels.size()); ++level, ++count)
            if (covers.shows(last, level, voxel >> level, face)) break;
        return count;
    }
    void check(int size, int cascades) {
        use_cone_tracing(scene, size);
        change_settings(scene, [&](RenderSettings& s) { s.cascades = cascades, s.bounces = 1, s.shadow_map_size = 64; });
        Renderer renderer = new_renderer();
        frame(renderer, scene, camera, 8);
        const Covers covers = covers_of(renderer, size);
        const auto words = device->read_back_as<std::uint32_t>(*renderer->voxels().inputs().occupancy).value();
        int wrong = 0, none = 0, most = 0;
        for (int i = 0; i < cascades * size * size * size; ++i)
            for (int face = 0; face < 6; ++face) {
                const glm::ivec3 voxel(i % size, i / size % size, i / (size * size) % size);
                const int said = static_cast<int>(words[i] >> shading::emptiness_bits * face & 15u);
                wrong += said != empty_levels(renderer, covers, i / (size * size * size), voxel, face);
                none += said == 0;
                most = std::max(most, said);
            }
        EXPECT_EQ(wrong, 0);
        EXPECT_GT(none, 0) << "the check must have something to check";
        EXPECT_GT(most, cascades);
    }
    Scene scene;
    Camera camera;
};

TEST_F(GiOccupancy, AWordTellsOfEachFaceHowManyLevelsAreEmptyAboutAVoxel) { check(32, 1); }
TEST_F(GiOccupancy, InnerCascadesGoOnCountingInTheNext) { check(32, 3); }

}  // namespace
}  // namespace heliodon::tests
