#!/usr/bin/env python3
"""Rays a second beside Embree's own sample, `pathtracer` (Debian: embree-tools), in its own Cornell box.

usage: bench/embree_pathtracer.py [--heliodon PROGRAM] [--size 512x512] [--spp 16] [--depth 8] [--threads N] [--runs 3]

Lambertian surfaces, a point light, one shadow and one scattered ray an event, paths of the same greatest length. Both programs run in turns; the
best run of each counts, of rendering alone. Beside rays a second stands relMSE against a converged picture of the same program, since rays are not
worth the same (Embree's are of 8 bits, which costs it next to nothing here).
"""
import argparse
import json
import os
import re
import subprocess
import tempfile

MODELS = "/usr/share/doc/embree3/models"
VIEW = {"position": [278, 273, -800], "target": [278, 273, 0], "vertical_fov_deg": 37}
LIGHT, INTENSITY = [213, 300, 227], 30000  # hardly a pixel above 1, where Embree's pictures of 8 bits end


def split_by_material(folder):
    """Each material's faces as an OBJ of their own, for a scene that gives them plain Lambertian colours."""
    vertices, faces, colours, name = [], {}, {}, None
    for line in open(os.path.join(MODELS, "cornell_box.mtl")):
        words = line.split()
        if words[:1] == ["newmtl"]:
            name = words[1]
        elif words[:1] == ["Kd"]:
            colours[name] = [float(word) for word in words[1:]]
    for line in open(os.path.join(MODELS, "cornell_box.obj")):
        words = line.split()
        if words[:1] == ["v"]:
            vertices.append(line)
        elif words[:1] == ["usemtl"]:
            name = words[1]
        elif words[:1] == ["f"]:
            corners = [int(word.split("/")[0]) for word in words[1:]]
            corners = [corner if corner > 0 else len(vertices) + 1 + corner for corner in corners]
            faces.setdefault(name, []).append("f " + " ".join(map(str, corners)) + "\n")
    nodes = [{"translate": LIGHT, "light": {"type": "point", "intensity_cd": INTENSITY}}]
    materials = {}
    for name, lines in faces.items():
        with open(os.path.join(folder, name + ".obj"), "w") as file:
            file.writelines(vertices + lines)
        materials[name] = {"model": "lambert", "base_color": colours[name], "two_sided": True}
        nodes.append({"mesh": name + ".obj", "material": name})
    scene = {"heliodon": 1, "cameras": [{"name": "front", **VIEW, "ev100": 0}], "materials": materials, "nodes": nodes}
    path = os.path.join(folder, "cornell.heliodon.json")
    with open(path, "w") as file:
        json.dump(scene, file)
    return path


def heliodon(options, scene, spp, output):
    stats = output + ".json"
    subprocess.run([options.heliodon, "render", scene, "--engine", "path", "--size", options.size, "--spp", str(spp), "--max-depth",
                    str(options.depth), "--threads", str(options.threads), "--stats", stats, "-o", output], check=True, capture_output=True)
    found = json.load(open(stats))
    return found["seconds"], found["rays_per_second"]


def embree(options, spp, output=None):
    width, height = options.size.split("x")
    words = lambda *values: [str(value) for value in values]
    command = ["pathtracer", "-i", os.path.join(MODELS, "cornell_box.obj"), *words("--pointlight", *LIGHT, *3 * [INTENSITY]),
               *words("--vp", *VIEW["position"], "--vi", *VIEW["target"], "--vu", 0, 1, 0, "--fov", VIEW["vertical_fov_deg"]),
               *words("--size", width, height, "--spp", spp, "--max-path-length", options.depth, "--threads", options.threads)]
    command += ["-o", output] if output else ["--benchmark", "1", "4"]
    text = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    if output:
        return None
    value = lambda name: float(re.search(name + r" ([\d.]+)", text).group(1))
    return 1 / value("BENCHMARK_RENDER_MAX"), 1e6 * value("BENCHMARK_RENDER_MRAYPS_MAX")


def error(options, reference, picture):
    text = subprocess.run([options.heliodon, "compare", reference, picture, "--json"], check=True, capture_output=True, text=True).stdout
    return json.loads(text)["relmse"]


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--heliodon", default="build/release/bin/heliodon")
    parser.add_argument("--size", default="512x512")
    parser.add_argument("--spp", type=int, default=16)
    parser.add_argument("--depth", type=int, default=8)
    parser.add_argument("--threads", type=int, default=os.cpu_count())
    parser.add_argument("--runs", type=int, default=3)
    parser.add_argument("--reference-spp", type=int, default=4096)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        scene = split_by_material(folder)
        at = lambda name: os.path.join(folder, name)
        ours, theirs = [], []
        for _ in range(options.runs):
            ours.append(heliodon(options, scene, options.spp, at("ours.pfm")))
            theirs.append(embree(options, options.spp))
        embree(options, options.spp, at("theirs.pfm"))
        heliodon(options, scene, options.reference_spp, at("our-reference.pfm"))
        embree(options, options.reference_spp, at("their-reference.pfm"))
        rows = [("Embree's pathtracer", min(theirs), error(options, at("their-reference.pfm"), at("theirs.pfm"))),
                ("heliodon", min(ours), error(options, at("our-reference.pfm"), at("ours.pfm")))]
        print(f"{options.size}, {options.spp} samples a pixel, at most {options.depth} events, {options.threads} threads")
        for name, (seconds, rays), relmse in rows:
            print(f"{name:20} {seconds:8.3f} s {rays / 1e6:8.2f} million rays a second   relMSE {relmse:.5f}   relMSE x s {relmse * seconds:.5f}")
        print(f"references against each other: relMSE {error(options, at('our-reference.pfm'), at('their-reference.pfm')):.5f}")


main()
