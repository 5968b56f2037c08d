#!/usr/bin/env python3
"""A room of each material: whether methods with photon maps show it as bidirectional path tracing does.

usage: bench/materials.py [--keyhole build/keyhole] [--materials "translucent;glass, ground"] [--methods ipm,mps] [--seconds 8]
                          [--reference-seconds 25] [--seed 1] [-j 2] [--out materials]

A wall, a box and a ball are of the material. Behind the wall is a second lamp, so that what lets light through shows it. References
are two renders by `bdpt`. For each method: trimmed squared relative error free of the references' noise, the brightness over
that of the references, and how far blocks of 16x16 pixels are off (root mean square).
"""
import argparse
import concurrent.futures
import os
import pathlib

from common import diff, render_for

ROOT = pathlib.Path(__file__).resolve().parent.parent
MATERIALS = {
    "diffuse": "{type: diffuse, reflectance: 0.6}",
    "translucent": "{type: diffuse_transmission, reflectance: 0.3, transmittance: 0.6}",
    "metal, rough": "{type: conductor, reflectance: [0.9, 0.7, 0.5], roughness: 0.3}",
    "metal, brushed": "{type: conductor, reflectance: [0.9, 0.7, 0.5], roughness: [0.05, 0.3]}",
    "metal, polished": "{type: conductor, reflectance: [0.9, 0.7, 0.5], roughness: 0.05}",
    "mirror": "{type: mirror}",
    "glass": "{type: glass}",
    "pane": "{type: thin_dielectric}",
    "glass, ground": "{type: dielectric, roughness: 0.5}",
    "glass, etched": "{type: dielectric, roughness: 0.05}",
    "varnish": "{type: coated_diffuse, reflectance: 0.5, roughness: 0}",
    "varnish, dull": "{type: coated_diffuse, reflectance: 0.5, roughness: 0.2}",
    "varnish, dark": "{type: coated_diffuse, reflectance: 0.5, roughness: 0.1, thickness: 0.5}",
    "lacquer": "{type: coated_conductor, reflectance: 0.8, roughness: 0.2, coat_roughness: 0.05}",
    "plastic": "{type: plastic, base_color: 0.6, roughness: 0.3}",
    "principled metal": "{type: principled, base_color: [0.8, 0.6, 0.3], metallic: 0.8, roughness: 0.3}",
    "principled coat": "{type: principled, base_color: [0.3, 0.6, 0.8], clearcoat: 1, clearcoat_roughness: 0.1}",
    "principled glass": "{type: principled, base_color: [0.8, 0.9, 0.8], transmission: 0.7, roughness: 0.3}",
    "velvet": "{type: principled, base_color: [0.5, 0.2, 0.2], sheen: 1, roughness: 0.8}",
    "mix": "{type: mix, a: {type: diffuse_transmission, reflectance: 0.3, transmittance: 0.6}, b: {type: diffuse, reflectance: 0.5}}",
    "mix with mirror": "{type: mix, a: {type: mirror}, b: {type: diffuse, reflectance: 0.5}, amount: 0.7}",
    "bumps": "{type: diffuse, reflectance: 0.6, bump: {type: checkerboard, a: 0, b: 0.01, repeat: [5, 5]}}",
}


def scene(material):
    gray = "material: {type: diffuse, reflectance: 0.55}"
    return f"""camera: {{from: [2.6, 1.6, 2.8], to: [1.2, 0.7, 0.8], fov: 65}}
materials:
  m: {material}
shapes:
  - {{type: rectangle, corner: [0, 0, 0], u: [0, 0, 3], v: [3, 0, 0], {gray}}}
  - {{type: rectangle, corner: [0, 2.5, 0], u: [3, 0, 0], v: [0, 0, 3], {gray}}}
  - {{type: rectangle, corner: [0, 0, 0], u: [3, 0, 0], v: [0, 2.5, 0], {gray}}}
  - {{type: rectangle, corner: [0, 0, 3], u: [0, 0, -3], v: [0, 2.5, 0], material: m}}
  - {{type: rectangle, corner: [3, 0, 0], u: [0, 0, 3], v: [0, 2.5, 0], {gray}}}
  - {{type: rectangle, corner: [3, 0, 3], u: [-3, 0, 0], v: [0, 2.5, 0], {gray}}}
  - {{type: box, min: [0.4, 0, 0.5], max: [1.1, 0.9, 1.2], material: m}}
  - {{type: sphere, center: [1.8, 0.401, 1.2], radius: 0.4, material: m}}
  - {{type: rectangle, corner: [1.2, 2.49, 0.8], u: [0.5, 0, 0], v: [0, 0, 0.5], emission: {{radiance: 12}}}}
  - {{type: rectangle, corner: [-1, 0, 4], u: [0, 0, -5], v: [0, 2.5, 0], {gray}}}
  - {{type: rectangle, corner: [-0.7, 1.5, 1.2], u: [0.3, 0, 0], v: [0, 0, 0.3], emission: {{radiance: 12}}}}
"""


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--keyhole", default=str(ROOT / "build/keyhole"))
    parser.add_argument("--materials")
    parser.add_argument("--methods", default="ipm,mps")
    parser.add_argument("--seconds", type=float, default=8)
    parser.add_argument("--reference-seconds", type=float, default=25)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("-j", "--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--out", default="materials")
    args = parser.parse_args()
    out = pathlib.Path(args.out)
    out.mkdir(parents=True, exist_ok=True)
    names, methods = args.materials.split(";") if args.materials else list(MATERIALS), args.methods.split(",")

    def file(name, end):
        return out / f"{name.replace(' ', '-').replace(',', '')}.{end}"

    def render(name, method, seconds, seed, picture):
        render_for(args.keyhole, file(name, "yaml"), seconds, method, seed, "64x48", picture)

    jobs = []
    for name in names:
        file(name, "yaml").write_text(scene(MATERIALS[name]))
        jobs += [(name, "bdpt", args.reference_seconds, 100 + i, file(name, f"{i}.exr")) for i in (1, 2)
                 if not file(name, f"{i}.exr").exists()]
        jobs += [(name, m, args.seconds, args.seed, file(name, f"{m}.exr")) for m in methods]
    with concurrent.futures.ThreadPoolExecutor(args.jobs) as pool:
        list(pool.map(lambda job: render(*job), jobs))

    print("| material | " + " | ".join(f"`{m}`: error | brightness | blocks" for m in methods) + " |")
    print("| --- |" + " --- |" * (3 * len(methods)))
    for name in names:
        found = [diff(args.keyhole, file(name, f"{m}.exr"), file(name, "1.exr"), file(name, "2.exr")) for m in methods]
        print(f"| {name} | " + " | ".join(f"{d['cross_trim']:.2g} | {d['ratio']:.3f} | {d['block']:.3f}" for d in found) + " |")


if __name__ == "__main__":
    main()
