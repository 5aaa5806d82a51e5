// What the kernel fetches, for eight lanes: the counterpart of CpuKernel's members. The translated kernel includes this
// behind its structures, in namespace heliodon::trace::lanes. Lanes that are not active may ask for anything.

/// Lanes that are not active read the first record.
template <class Ref, class T>
inline Ref record(const T* table, Mask m, Uint index, int stride = sizeof(T)) {
    return {{reinterpret_cast<const char*>(table), ((Int)index & m) * stride}};
}
inline Float word(const float* table, Mask m, Uint index) {
    return gather(reinterpret_cast<const char*>(table), ((Int)index & m) * 4);
}
inline Uint word(const std::uint32_t* table, Mask m, Uint index) {
    return (Uint)gather(reinterpret_cast<const char*>(table), ((Int)index & m) * 4);
}

inline KernelFrameRef kernel_frame(const LaneScene& k, Mask) {
    return {{k.frame}};
}
inline SkyDataRef fetch_sky(const LaneScene& k, Mask) {
    return {{k.sky}};
}
inline InstanceDataRef fetch_instance(const LaneScene& k, Mask m, Uint i) {
    return record<InstanceDataRef>(k.instances, m, i);
}
inline MaterialDataRef fetch_material(const LaneScene& k, Mask m, Uint i) {
    return record<MaterialDataRef>(k.materials, m, i);
}
inline LightDataRef fetch_light(const LaneScene& k, Mask m, Uint i) {
    return record<LightDataRef>(k.lights, m, i);
}
inline KernelEmitterRef fetch_emitter(const LaneScene& k, Mask m, Uint i) {
    return record<KernelEmitterRef>(k.emitters, m, i);
}
inline KernelLightNodeRef fetch_light_node(const LaneScene& k, Mask m, Uint i) {
    return record<KernelLightNodeRef>(k.light_nodes, m, i);
}
inline KernelGeometryRef fetch_geometry(const LaneScene& k, Mask m, Uint i) {
    return record<KernelGeometryRef>(&k.geometries->kernel, m, i, sizeof(GeometryArrays));
}
inline Uint fetch_first_emitter(const LaneScene& k, Mask m, Uint i) {
    return word(k.first_emitter, m, i);
}
inline Uint fetch_light_emitter(const LaneScene& k, Mask m, Uint i) {
    return word(k.light_emitter, m, i);
}
inline Uint fetch_visible_light(const LaneScene& k, Mask m, Uint i) {
    return word(k.visible_lights, m, i);
}
inline Float fetch_sky_cumulative(const LaneScene& k, Mask m, Uint i) {
    return word(k.sky_cumulative, m, i);
}
inline Float luminaire_value(const LaneScene& k, Mask m, Uint i) {
    return word(k.luminaire_table, m, i);
}
inline Float shading_table(const LaneScene& k, Mask m, Uint i) {
    return word(k.shading_tables(), m, i);
}

// -- vertices

/// Lanes that are not active get what the first active one has.
inline Uint as_first(Mask m, Uint x) {
    const Uint first = lift(static_cast<std::uint32_t>(__builtin_ctz(bits(m))));
    return choose(m, x, (Uint)_mm256_permutevar8x32_epi32((__m256i)x, (__m256i)first));
}
/// 16 bytes at element `index` of the array whose pointer stands `array` bytes into each lane's GeometryArrays: all
/// arrays are padded by that.
template <class Element, std::size_t array>
[[gnu::always_inline]] inline Vec4<Float> vertex_rows(const LaneScene& k, Mask m, Uint geometry, Uint index,
                                                      Uint which = Uint{}) {
    const Uint where =
        as_first(m, geometry * std::uint32_t{sizeof(GeometryArrays)} + which * std::uint32_t{sizeof(void*)});
    const __m256i element = (__m256i)as_first(m, index);
    const auto* pointers = reinterpret_cast<const long long*>(reinterpret_cast<const char*>(k.geometries) + array);
    const __m256i size = _mm256_set1_epi64x(sizeof(Element));
    alignas(32) const float* at[lane_count];
    const auto four = [&](int half) {
        const __m128i place =
            half ? _mm256_extracti128_si256((__m256i)where, 1) : _mm256_castsi256_si128((__m256i)where);
        const __m128i number = half ? _mm256_extracti128_si256(element, 1) : _mm256_castsi256_si128(element);
        const __m256i first = _mm256_i32gather_epi64(pointers, place, 1);
        const __m256i sum = _mm256_add_epi64(first, _mm256_mul_epu32(_mm256_cvtepu32_epi64(number), size));
        _mm256_store_si256(reinterpret_cast<__m256i*>(at + 4 * half), sum);
    };
    four(0), four(1);
    return load_rows(at);
}
inline Vec3<Uint> fetch_triangle(const LaneScene& k, Mask m, Uint geometry, Uint primitive) {
    const auto row = vertex_rows<std::uint32_t, offsetof(GeometryArrays, indices)>(k, m, geometry, 3u * primitive);
    return {(Uint)row.x, (Uint)row.y, (Uint)row.z};
}
inline Vec3<Float> fetch_position(const LaneScene& k, Mask m, Uint geometry, Uint vertex) {
    const auto row = vertex_rows<glm::vec3, offsetof(GeometryArrays, positions)>(k, m, geometry, vertex);
    return {row.x, row.y, row.z};
}
inline Vec3<Float> fetch_normal(const LaneScene& k, Mask m, Uint geometry, Uint vertex) {
    const auto row = vertex_rows<glm::vec3, offsetof(GeometryArrays, normals)>(k, m, geometry, vertex);
    return {row.x, row.y, row.z};
}
inline Vec4<Float> fetch_tangent(const LaneScene& k, Mask m, Uint geometry, Uint vertex) {
    return vertex_rows<glm::vec4, offsetof(GeometryArrays, tangents)>(k, m, geometry, vertex);
}
inline Vec4<Float> fetch_color(const LaneScene& k, Mask m, Uint geometry, Uint vertex) {
    return vertex_rows<glm::vec4, offsetof(GeometryArrays, colors)>(k, m, geometry, vertex);
}
inline Vec2<Float> fetch_texcoord(const LaneScene& k, Mask m, Uint geometry, Uint set, Uint vertex) {
    const auto row = vertex_rows<glm::vec2, offsetof(GeometryArrays, texcoords)>(k, m, geometry, vertex, set);
    return {row.x, row.y};
}

// -- textures: TextureTable::sample and size

/// A texture a lane; of lanes that are not active any.
struct LaneTexture {
    const char* entries;
    Int offset;  // of its entry, bytes

    [[nodiscard]] Int number(std::size_t member) const { return (Int)gather(entries + member, offset); }
    [[nodiscard]] Int width() const { return number(offsetof(TextureTable::Entry, width)); }
    [[nodiscard]] Int height() const { return number(offsetof(TextureTable::Entry, height)); }
    /// Of what stands `bytes` behind the first texel, of lanes 0 to 3 or 4 to 7.
    [[nodiscard]] __m256i addresses(int half, Int bytes) const {
        static_assert(offsetof(TextureTable::Entry, texels) == 0);
        const auto four = [&](Int x) {
            return half ? _mm256_extracti128_si256((__m256i)x, 1) : _mm256_castsi256_si128((__m256i)x);
        };
        return _mm256_add_epi64(_mm256_i32gather_epi64(reinterpret_cast<const long long*>(entries), four(offset), 1),
                                _mm256_cvtepu32_epi64(four(bytes)));
    }
};
inline LaneTexture texture_of(const LaneScene& k, Mask m, Uint index) {
    return {reinterpret_cast<const char*>(k.textures.entries),
            (Int)min(index & (Uint)m, lift(k.textures.count)) * int{sizeof(TextureTable::Entry)}};
}

/// The texels below and above a coordinate along one axis, and how far it is towards the second.
struct LaneTexels {
    Int first, second;
    Float part;
};
inline LaneTexels texels_along(Float u, Int size, Int wrap, Float half) {
    const Float width = to_float(size);
    const Mask repeat = wrap == static_cast<int>(Wrap::repeat), clamps = wrap == static_cast<int>(Wrap::clamp_to_edge);
    // Within one period (mirrored: of two).
    const Float period = choose(repeat, lift(1.0f), lift(2.0f));
    const Float within = choose(clamps, clamp(u, 0.0f, 1.0f), u - floor(u / period) * period);
    const Float x = choose(abs(u) < 1e9f, within * width, Float{}) - half;
    const Float below = floor(x);
    const Int last = size - 1, count = choose(repeat, size, size + size);
    const auto wrapped = [&](Int i) {
        Int inside = choose(i < 0, i + count, i);
        inside = choose(inside >= count, inside - count, inside);
        inside = choose(inside > last, count - 1 - inside, inside);
        return choose(
            clamps, (Int)_mm256_min_epi32(_mm256_max_epi32((__m256i)i, _mm256_setzero_si256()), (__m256i)last), inside);
    };
    const Int first = (Int)to_uint(below);
    return {wrapped(first), wrapped(first + 1), x - below};
}

/// The texels number `at`, as they are stored.
inline Uint texel_bytes(const LaneTexture& texture, Int at) {
    const auto four = [&](int half) {
        return _mm256_i64gather_epi32(static_cast<const int*>(nullptr), texture.addresses(half, at * 4), 1);
    };
    return (Uint)_mm256_set_m128i(four(1), four(0));
}
/// Decoded; `at` their number, of those of four floats.
inline Vec4<Float> decoded(const LaneScene& k, const LaneTexture& texture, Int format, Uint bytes, Int at) {
    const Mask srgb = format == static_cast<int>(TextureFormat::srgb8),
               floats = format == static_cast<int>(TextureFormat::float32);
    const auto decode = [&](Uint byte) {
        const Float linear = to_float((Int)byte) / 255.0f;
        return any(srgb) ? choose(srgb, gather(reinterpret_cast<const char*>(k.textures.srgb), (Int)byte * 4), linear)
                         : linear;
    };
    Vec4<Float> result = {decode(bytes & 255u), decode(bytes >> 8u & 255u), decode(bytes >> 16u & 255u),
                          to_float((Int)(bytes >> 24u)) / 255.0f};
    if (any(floats)) {
        alignas(32) const float* rows[lane_count];
        for (int half = 0; half < 2; ++half)
            _mm256_store_si256(reinterpret_cast<__m256i*>(rows + 4 * half), texture.addresses(half, at * 16 & floats));
        assign(floats, result, load_rows(rows));
    }
    return result;
}

inline Vec4<Float> scene_texture(const LaneScene& k, Mask m, Uint index, const Vec2<Float>& uv) {
    using Entry = TextureTable::Entry;
    constexpr std::size_t format_at = offsetof(Entry, format);
    static_assert(offsetof(Entry, wrap_u) == format_at + 1 && offsetof(Entry, wrap_v) == format_at + 2 &&
                  offsetof(Entry, nearest) == format_at + 3);
    const LaneTexture texture = texture_of(k, m, index);
    const Int modes = texture.number(format_at), width = texture.width(), format = modes & 255;
    const Mask nearest = (modes >> 24 & 255) != 0;
    const Float half = choose(nearest, Float{}, lift(0.5f));
    const LaneTexels x = texels_along(uv.x, width, modes >> 8 & 255, half);
    const LaneTexels y = texels_along(uv.y, texture.height(), modes >> 16 & 255, half);
    const Int top = y.first * width, bottom = y.second * width;
    const Int at[4] = {top + x.first, top + x.second, bottom + x.first, bottom + x.second};
    Uint bytes[4];  // all are on their way before the first is decoded
    for (int i = 0; i < 4; ++i) bytes[i] = texel_bytes(texture, at[i]);
    const Float across = choose(nearest, Float{}, x.part), down = choose(nearest, Float{}, y.part);
    const auto texel = [&](int i) { return decoded(k, texture, format, bytes[i], at[i]); };
    const auto between = [](const Vec4<Float>& a, const Vec4<Float>& b, Float t) {
        return each(a, b, [t](Float p, Float q) { return mix(p, q, t); });
    };
    return between(between(texel(0), texel(1), across), between(texel(2), texel(3), across), down);
}
inline Vec2<Float> scene_texture_size(const LaneScene& k, Mask m, Uint index) {
    const LaneTexture texture = texture_of(k, m, index);
    return {to_float(texture.width()), to_float(texture.height())};
}
