#version 460
// Draws instead of a triangle the rectangle around it.
layout(triangles) in;
layout(triangle_strip, max_vertices = 4) out;

void main() {
    const vec2 a = gl_in[0].gl_Position.xy;
    const vec2 b = gl_in[1].gl_Position.xy;
    const vec2 c = gl_in[2].gl_Position.xy;
    const vec2 low = min(a, min(b, c));
    const vec2 high = max(a, max(b, c));
    for (int corner = 0; corner < 4; ++corner) {
        gl_Position = vec4(mix(low, high, vec2(corner & 1, corner >> 1)), 0.5, 1.0);
        EmitVertex();
    }
    EndPrimitive();
}
