#!/usr/bin/env python3
"""Daylight at 8:00 and 11:00, real time beside path traced, and the sun's shadows alone: the tables of docs/accuracy.md.

    bench/daylight.py --scenes DIR --out DIR [--heliodon PROGRAM] [--size 512x384] [car sponza house]

DIR of --scenes holds car-day.heliodon.json and sponza-day.heliodon.json; the house is this repository's. References that
already lie in --out are taken as they are.
"""
import argparse
import array
import json
import math
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent


@dataclass
class Scene:
    file: Path
    day: str
    latitude_deg: float
    longitude_deg: float
    reference_spp: int

    def options(self, hour):
        place = ["--set", f"sky.latitude_deg={self.latitude_deg}", "--set", f"sky.longitude_deg={self.longitude_deg}"]
        return [*place, "--time", self.moment(hour)]

    def moment(self, hour):
        return f"{self.day}T{hour:02}:00:00+02:00"


REALTIME = ["--gi", "vct", "--voxels", "256", "--set", "render.cascades=3"]
WIDE = ["--set", "render.vct.narrow=false"]
MODES = {"one frame": ["--spp", "1", *WIDE], "64 frames, wide": ["--spp", "64", *WIDE], "64 frames": ["--spp", "64"],
         "64 frames, 36 cones": ["--spp", "64", "--set", "render.vct.cones=36"]}
SHADOWS = {"cascades": [], "volumes": ["--set", "render.sun_shadows=volumes"]}


class Program:
    def __init__(self, path, size):
        self.path, self.size = path, size

    def __call__(self, *arguments):
        ended = subprocess.run([self.path, *map(str, arguments)], capture_output=True, text=True)
        if ended.returncode != 0:
            sys.exit(f"{' '.join(map(str, arguments))}\n{ended.stderr}")
        return ended.stdout

    def render(self, scene, output, options):
        pictures = [x for ending in ("exr", "jpg") for x in ("-o", output.with_suffix("." + ending))]
        self("render", scene, "--size", self.size, *options, *pictures)

    def compare(self, reference, test, *options):
        return json.loads(self("compare", reference.with_suffix(".exr"), test.with_suffix(".exr"), "--json", *options))


def sun_alone(program, scene, hour, output):
    """The scene under nothing but a directional light from where the sun stands, with its true angle."""
    place = ["--latitude-deg", scene.latitude_deg, "--longitude-deg", scene.longitude_deg, "--time", scene.moment(hour)]
    sun = json.loads(program("sun", *place, "--json"))
    azimuth, elevation = (math.radians(sun[key]) for key in ("azimuth_deg", "elevation_deg"))
    towards = (math.sin(azimuth) * math.cos(elevation), math.sin(elevation), -math.cos(azimuth) * math.cos(elevation))
    content = json.loads(scene.file.read_text())
    content["sky"] = {"model": "none"}

    def resolve(nodes):
        for node in nodes:
            if "mesh" in node:
                node["mesh"] = str((scene.file.parent / node["mesh"]).resolve())
            resolve(node.get("children", []))

    resolve(content["nodes"])
    light = {"type": "directional", "illuminance_lux": [80000] * 3, "direction": [-x for x in towards], "angular_diameter_deg": 0.53}
    content["nodes"].append({"name": "the sun alone", "light": light})
    output.write_text(json.dumps(content))
    return output


def luminances(pfm):
    with open(pfm, "rb") as file:
        file.readline(), file.readline(), file.readline()
        values = array.array("f", file.read())
    return [0.2126 * values[i] + 0.7152 * values[i + 1] + 0.0722 * values[i + 2] for i in range(0, len(values), 3)]


def differing(reference, test):
    """The share of pixels that differ by more than 2 % of what the brightest hundredth begins at."""
    truth = luminances(reference)
    bound = 0.02 * sorted(truth)[len(truth) * 99 // 100]
    return sum(abs(a - b) > bound for a, b in zip(truth, luminances(test))) / len(truth)


def pictures(program, name, scene, hour, out):
    base, options = out / f"{name}-{hour:02}", scene.options(hour)
    path = Path(f"{base}-path")
    if not path.with_suffix(".exr").exists():
        program.render(scene.file, path, ["--engine", "path", "--spp", scene.reference_spp, *options])
    for mode, settings in MODES.items():
        picture = Path(f"{base}-{mode.replace(', ', '-').replace(' ', '-')}")
        program.render(scene.file, picture, [*REALTIME, *settings, *options])
        error = program.compare(path, picture, "--heatmap", f"{picture}-flip.png")
        print(f"| {name} | {hour}:00 | {mode} | {error['median_relative']:.3f} | {error['relmse']:.2g} | {error['flip']:.3f} |", flush=True)


def shadows(program, name, scene, hour, out):
    base = out / f"{name}-{hour:02}-sun"
    alone = sun_alone(program, scene, hour, Path(f"{base}.heliodon.json"))
    both = ["--size", program.size, "-o"]
    path = Path(f"{base}-path.pfm")
    program("render", alone, "--engine", "path", "--max-depth", 1, "--spp", 256, *both, path, "-o", path.with_suffix(".exr"))
    for kind, settings in SHADOWS.items():
        test = Path(f"{base}-{kind}.pfm")
        program("render", alone, "--gi", "none", "--spp", 64, *settings, *both, test, "-o", test.with_suffix(".exr"))
        flip = program.compare(path, test)["flip"]
        print(f"| {name} | {hour}:00 | {kind} | {100 * differing(path, test):.2f} % | {flip:.4f} |", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--scenes", type=Path, required=True)
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--heliodon", default=ROOT / "build/release/bin/heliodon")
    parser.add_argument("--size", default="512x384")
    parser.add_argument("names", nargs="*", metavar="car sponza house")
    arguments = parser.parse_args()
    known = {
        "car": Scene(arguments.scenes / "car-day.heliodon.json", "2026-06-21", 48.8, 9.2, 96),
        "sponza": Scene(arguments.scenes / "sponza-day.heliodon.json", "2026-06-21", 42.64, 18.11, 2048),
        "house": Scene(ROOT / "examples/house/house.heliodon.json", "2026-04-21", 47.4, 8.5, 128),
    }
    if unknown := set(arguments.names) - set(known):
        parser.error(f"expected names out of {', '.join(known)}, found {', '.join(sorted(unknown))}")
    arguments.out.mkdir(parents=True, exist_ok=True)
    program = Program(arguments.heliodon, arguments.size)
    chosen = [(name, known[name], hour) for name in arguments.names or known for hour in (8, 11)]
    for step in (pictures, shadows):
        for name, scene, hour in chosen:
            step(program, name, scene, hour, arguments.out)


if __name__ == "__main__":
    main()
