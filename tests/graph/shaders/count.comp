#version 460

layout(local_size_x = 1) in;
layout(binding = 0) buffer Counter { uint counter; };
layout(binding = 1) writeonly buffer Groups { uint groups[3]; };

void main() {
    counter += 1u;
    groups[0] = counter;
    groups[1] = 1u;
    groups[2] = 1u;
}
