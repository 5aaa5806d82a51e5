#!/bin/bash
# Renders the pictures of tests/references anew. The scenes not in tests/scenes are the shared data's.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
shared=${HELIODON_SHARED:-$root/../shared}
for scene in "$shared/scenes/cornell-point" "$shared/scenes/natus" "$root/tests/scenes/three-lights"; do
    "$root/run" render "$scene.heliodon.json" --engine path --max-depth 1 --spp 1024 --no-environment --size 256x256 \
        -o "$root/tests/references/$(basename "$scene").exr"
done
