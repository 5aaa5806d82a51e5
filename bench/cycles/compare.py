#!/usr/bin/env python3
"""Heliodon's path tracer against Blender's Cycles: time to the same error, on the same machine in the same run.

usage: bench/cycles/compare.py [--heliodon PROGRAM] [--size 512x512] [--reference-spp 4096] [--threads N] SCENE.heliodon.json...

Needs `blender` (with python3-numpy for GLB models). Both engines render the same Lambertian scene with box-filtered pixels
and 12 bounces, without denoiser, clamping or adaptive sampling. Each picture's relMSE (heliodon compare) is taken against a
converged reference of the same engine, so that neither is held to the other's idea of the scene; the means of the
two references must agree within 1 %. Runs of the two engines take turns. A model's materials are reduced to their base
colours in a copy of the GLB that both engines read.
"""
import argparse
import json
import math
import os
import struct
import subprocess
import sys
import tempfile

BOUNCES = 12
HERE = os.path.dirname(os.path.abspath(__file__))


def lambertian_glb(source, target):
    """Base colours and their alpha only, two-sided, without a specular interface."""
    with open(source, "rb") as file:
        header = file.read(12)
        length, kind = struct.unpack("<II", file.read(8))
        document, rest = json.loads(file.read(length)), file.read()
    for material in document.get("materials", []):
        base = material.get("pbrMetallicRoughness", {})
        kept = {key: base[key] for key in ("baseColorFactor", "baseColorTexture") if key in base}
        kept.update(metallicFactor=0, roughnessFactor=1)
        for key in ("normalTexture", "occlusionTexture", "emissiveTexture", "emissiveFactor"):
            material.pop(key, None)
        material.update(pbrMetallicRoughness=kept, doubleSided=True, extensions={"KHR_materials_specular": {"specularFactor": 0}})
    document["extensionsUsed"] = sorted({*document.get("extensionsUsed", []), "KHR_materials_specular"})
    body = json.dumps(document).encode()
    body += b" " * (-len(body) % 4)
    with open(target, "wb") as file:
        file.write(header[:8] + struct.pack("<I", 12 + 8 + len(body) + len(rest)) + struct.pack("<II", len(body), kind) + body + rest)


def reduced(scene_file, folder):
    description = json.load(open(scene_file))
    for node in description["nodes"]:
        if "mesh" in node:
            source = os.path.join(os.path.dirname(os.path.abspath(scene_file)), node["mesh"])
            node["mesh"] = os.path.join(folder, os.path.basename(source))
            lambertian_glb(source, node["mesh"])
    path = os.path.join(folder, os.path.basename(scene_file))
    json.dump(description, open(path, "w"))
    return path


class Comparison:
    def __init__(self, arguments, scene, folder):
        self.arguments, self.scene, self.folder = arguments, scene, folder
        self.size = [int(n) for n in arguments.size.split("x")]
        camera = json.load(open(scene))["cameras"][0]
        self.ev100 = math.log2(camera["aperture_f"] ** 2 / camera["shutter_s"] * 100 / camera["iso"])

    def blender(self, options):
        script = os.path.join(HERE, "scene_in_cycles.py")
        run = subprocess.run(["blender", "-b", "--factory-startup", "-P", script, "--", json.dumps(options)], capture_output=True, text=True)
        for line in run.stdout.splitlines():
            if line.startswith("CYCLES "):
                return json.loads(line[7:])
        sys.exit(f"Blender did not finish:\n{run.stdout[-2000:]}{run.stderr[-2000:]}")

    def cycles(self, samples, seed):
        output = os.path.join(self.folder, f"cycles-{samples}-{seed}.exr")
        options = {"scene": self.scene, "size": self.size, "threads": self.arguments.threads, "bounces": BOUNCES,
                   "renders": [[samples, seed, output]]}
        return output, self.blender(options)["seconds"]

    def heliodon(self, samples, seed):
        output, stats = (os.path.join(self.folder, f"heliodon-{samples}-{seed}.{end}") for end in ("exr", "json"))
        subprocess.run([self.arguments.heliodon, "render", self.scene, "--engine", "path", "--size", self.arguments.size, "--spp", str(samples),
                        "--seed", str(seed), "--max-depth", str(BOUNCES + 1), "--stats", stats, "-o", output], check=True, capture_output=True)
        return output, json.load(open(stats))["seconds"]

    def compare(self, reference, test):
        run = subprocess.run([self.arguments.heliodon, "compare", reference, test, "--ev100", str(self.ev100), "--json"],
                             check=True, capture_output=True, text=True)
        return json.loads(run.stdout)

    def run(self):
        engines = {"Cycles": self.cycles, "Heliodon": self.heliodon}
        print(f"\n{os.path.basename(self.scene)}, {self.arguments.size}, {self.arguments.threads} threads")
        references = {name: render(self.arguments.reference_spp, 1000)[0] for name, render in engines.items()}
        apart = self.compare(references["Cycles"], references["Heliodon"])
        means = self.blender({"means": list(references.values())})
        print(f"references ({self.arguments.reference_spp} samples): relMSE {apart['relmse']:.2g}, FLIP {apart['flip']:.4f}, "
              f"mean of Heliodon's {100 * (means[1] / means[0] - 1):+.2f} %")
        curves = {name: [] for name in engines}
        print("| engine | samples | seconds | relMSE | relMSE × s |\n|---|---|---|---|---|")
        for samples in self.arguments.spp:
            for name, render in engines.items():
                picture, seconds = render(samples, 1)
                error = self.compare(references[name], picture)["relmse"]
                curves[name].append((seconds, error))
                print(f"| {name} | {samples} | {seconds:.2f} | {error:.6f} | {error * seconds:.5f} |", flush=True)
        for seconds, error in curves["Cycles"]:
            print(f"relMSE {error:.6f}: Cycles {seconds:.2f} s, Heliodon {time_to(curves['Heliodon'], error):.2f} s, "
                  f"ratio {time_to(curves['Heliodon'], error) / seconds:.3f}")


def time_to(curve, error):
    """By interpolation of log time over log error; beyond the measured points by the nearest one's error × time."""
    for (t0, e0), (t1, e1) in zip(curve, curve[1:]):
        if e1 <= error <= e0:
            share = (math.log(e0) - math.log(error)) / (math.log(e0) - math.log(e1))
            return math.exp(math.log(t0) + share * (math.log(t1) - math.log(t0)))
    time, reached = curve[0] if error > curve[0][1] else curve[-1]
    return time * reached / error


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--heliodon", default="build/release/bin/heliodon")
    parser.add_argument("--size", default="512x512")
    parser.add_argument("--reference-spp", type=int, default=4096)
    parser.add_argument("--spp", type=lambda text: [int(n) for n in text.split(",")], default=[4, 16, 64, 256])
    parser.add_argument("--threads", type=int, default=os.cpu_count())
    parser.add_argument("scenes", nargs="+")
    arguments = parser.parse_args()
    for scene in arguments.scenes:
        with tempfile.TemporaryDirectory() as folder:
            Comparison(arguments, reduced(scene, folder), folder).run()


if __name__ == "__main__":
    main()
