"""Writes bsdf.json: values, densities and delta lobes of Mitsuba 3's BSDF plugins, which bsdf_golden_test.cpp compares.

Needs the packages mitsuba (3.9) and numpy. Mitsuba computes in float (variant scalar_rgb), so values carry about 1e-5.
phong, which Mitsuba 3 does not have, is computed here in double from the model's definition.

usage: python make_bsdf_golden.py > bsdf.json
"""
import json
import math
import re

import mitsuba as mi
import numpy as np

mi.set_variant("scalar_rgb")

DIFFUSE = [0.7, 0.4, 0.2]
SPECULAR = [0.9, 0.8, 0.7]
TRANSMITTANCE = [0.6, 0.9, 0.8]
METAL = {"eta": [1.66, 0.88, 0.52], "k": [9.22, 6.27, 4.84]}
GLASS = {"intIor": 1.5, "extIor": 1.1}

# Fields are those of the materials in engine/scene/scene.h.
MATERIALS = [{"type": "diffuse", "diffuse": DIFFUSE}]
MATERIALS += [{"type": "conductor", "specular": SPECULAR, **METAL}]
MATERIALS += [{"type": "conductor", "material": "none", "specular": SPECULAR}]
MATERIALS += [{"type": "dielectric", "specular": SPECULAR, "transmittance": TRANSMITTANCE, **GLASS}]
MATERIALS += [{"type": "thindielectric", "specular": SPECULAR, "transmittance": TRANSMITTANCE, **GLASS}]
for distribution in ["ggx", "beckmann"]:
    for alpha in [0.1, 0.3, 0.8]:
        rough = {"distribution": distribution, "alpha": alpha}
        MATERIALS += [{"type": "roughconductor", "specular": SPECULAR, **METAL, **rough}]
        MATERIALS += [
            {"type": "roughdielectric", "specular": SPECULAR, "transmittance": TRANSMITTANCE, **GLASS, **rough}
        ]
    for alpha, nonlinear in [(0.1, False), (0.3, True)]:
        rough = {"distribution": distribution, "alpha": alpha, "nonlinear": nonlinear}
        MATERIALS += [{"type": "roughplastic", "diffuse": DIFFUSE, "specular": SPECULAR, **GLASS, **rough}]
for nonlinear in [False, True]:
    MATERIALS += [{"type": "plastic", "diffuse": DIFFUSE, "specular": SPECULAR, "nonlinear": nonlinear, **GLASS}]
MATERIALS += [{"type": "diffuse", "diffuse": DIFFUSE, "opacity": 0.3}]
for exponent in [1, 30, 1000]:
    MATERIALS += [{"type": "phong", "diffuse": [0.5, 0.3, 0.1], "specular": [0.2, 0.4, 0.3], "exponent": exponent}]
for distribution in ["ggx", "beckmann"]:
    rough = {"distribution": distribution, "alpha": 0.15, "alphaV": 0.5}
    MATERIALS += [{"type": "roughconductor", "specular": SPECULAR, **METAL, **rough}]
    MATERIALS += [{"type": "roughdielectric", "specular": SPECULAR, "transmittance": TRANSMITTANCE, **GLASS, **rough}]
BASE = [0.8, 0.5, 0.2]
COAT = {"roughness": 0.4, "anisotropic": 0.6, "spec_tint": 0.5, "sheen": 0.4, "sheen_tint": 0.5, "flatness": 0.4}
MATERIALS += [{"type": "principled", "base": BASE, "numbers": {"roughness": 0.5}}]
MATERIALS += [
    {"type": "principled", "base": BASE, "numbers": {**COAT, "metallic": 0.3, "clearcoat": 0.8, "clearcoat_gloss": 0.2}}
]
for eta in [1.4, 0.8]:
    numbers = {"eta": eta, "roughness": 0.5, "anisotropic": 0.3, "spec_trans": 0.7, "spec_tint": 0.2, "metallic": 0.2}
    MATERIALS += [{"type": "principled", "base": BASE, "numbers": {**numbers, "clearcoat": 0.5}}]
MATERIALS += [{"type": "principledthin", "base": BASE, "numbers": {**COAT, "diff_trans": 0.8}}]
MATERIALS += [{"type": "principledthin", "base": BASE, "numbers": {**COAT, "spec_trans": 0.7, "diff_trans": 0.8, "eta": 1.4}}]
PAINT, POLISHED = {"type": "diffuse", "diffuse": DIFFUSE}, {"type": "conductor", "specular": SPECULAR, **METAL}
SATIN = {"type": "roughconductor", "specular": SPECULAR, "distribution": "ggx", "alpha": 0.3, **METAL}
FROST = {"type": "roughdielectric", "distribution": "ggx", "alpha": 0.3, **GLASS}
MATERIALS += [{"type": "blendbsdf", "weight": 0.3, "parts": [PAINT, SATIN]}]
MATERIALS += [{"type": "blendbsdf", "weight": 0.6, "parts": [FROST, PAINT]}]
MATERIALS += [{"type": "blendbsdf", "weight": 0.25, "parts": [POLISHED, {**SATIN, "opacity": 0.6}], "opacity": 0.8}]


def rgb(value):
    return {"type": "rgb", "value": value}


def plugin(material):
    """The Mitsuba plugin of a material."""
    result = {"type": material["type"], **material.get("numbers", {})}
    if "base" in material:
        result["base_color"] = rgb(material["base"])
    if "parts" in material:
        result["weight"] = material["weight"]
        result["first"], result["second"] = [plugin(part) for part in material["parts"]]
    for name in ["distribution", "alpha", "nonlinear", "material"]:
        if name in material:
            result[name] = material[name]
    if "alphaV" in material:
        result["alpha_u"], result["alpha_v"] = result.pop("alpha"), material["alphaV"]
    if "intIor" in material:
        result["int_ior"], result["ext_ior"] = material["intIor"], material["extIor"]
    for name in ["eta", "k"]:
        if name in material:
            result[name] = rgb(material[name])
    if "diffuse" in material:
        name = "reflectance" if material["type"] == "diffuse" else "diffuse_reflectance"
        result[name] = rgb(material["diffuse"])
    if "specular" in material:
        result["specular_reflectance"] = rgb(material["specular"])
    if "transmittance" in material:
        result["specular_transmittance"] = rgb(material["transmittance"])
    if "opacity" in material:
        result = {"type": "mask", "opacity": material["opacity"], "nested": result}
    return mi.load_dict(result)


def direction(theta, phi):
    return [math.sin(theta) * math.cos(phi), math.sin(theta) * math.sin(phi), math.cos(theta)]


def pairs(material):
    """Directions (wi, wo): spread over the sphere, and near the mirror and refracted directions, where lobes are."""
    rng = np.random.default_rng(1)
    result = []
    for theta in [0.02, 0.5, 1.1, 1.5, math.pi - 0.3, math.pi - 1.2]:
        wi = direction(theta, 0.7)
        for _ in range(5):
            result.append((wi, direction(math.acos(rng.uniform(-1, 1)), rng.uniform(0, 2 * math.pi))))
        for spread in [0.03, 0.2]:
            for side in [1, -1]:
                tilt, turn = rng.normal(0, spread, 2)
                wo = direction(theta + tilt, 0.7 + math.pi + turn)
                result.append((wi, [wo[0], wo[1], side * wo[2]]))
    return result


def interaction(wi):
    si = mi.SurfaceInteraction3f()
    si.wi = mi.Vector3f(*wi)
    return si


def phong(material, wi, wo):
    if wi[2] <= 0 or wo[2] <= 0:
        return [0, 0, 0], 0
    n = material["exponent"]
    luminance = lambda c: 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2]
    kd, ks = material["diffuse"], material["specular"]
    pick = luminance(ks) / (luminance(ks) + luminance(kd))
    power = max(0, -wi[0] * wo[0] - wi[1] * wo[1] + wi[2] * wo[2]) ** n
    value = [(d / math.pi + s * (n + 2) / (2 * math.pi) * power) * wo[2] for d, s in zip(kd, ks)]
    return value, pick * (n + 1) / (2 * math.pi) * power + (1 - pick) * wo[2] / math.pi


def rounded(values):
    return [float(f"{v:.7g}") for v in values]


def describe(material):
    record = {"material": material, "values": [], "deltas": []}
    bsdf = None if material["type"] == "phong" else plugin(material)
    if material["type"] == "plastic":  # Mitsuba's fit, where the renderer integrates
        record["fdrInt"] = float(re.search(r"fdr_int = ([\d.e-]+)", str(bsdf)).group(1))
    context = mi.BSDFContext()
    for wi, wo in pairs(material):
        if bsdf is None:
            value, pdf = phong(material, wi, wo)
        else:
            value = bsdf.eval(context, interaction(wi), mi.Vector3f(*wo))
            pdf = bsdf.pdf(context, interaction(wi), mi.Vector3f(*wo))
        both = ["roughdielectric", "diffuse", "principled", "principledthin", "blendbsdf"]
        if material["type"] in both or wi[2] * wo[2] > 0:  # else: trivially nothing
            item = {"wi": rounded(wi), "wo": rounded(wo), "fCos": rounded(value), "pdf": rounded([pdf])[0]}
            record["values"].append(item)
    if bsdf is None:
        return record
    for wi in [direction(theta, 0.7) for theta in [0.02, 0.5, 1.1, 1.5, math.pi - 0.3, math.pi - 1.2]]:
        for pick in [0.001, 0.2, 0.999]:
            sample, weight = bsdf.sample(context, interaction(wi), pick, mi.Point2f(0.3, 0.6))
            if int(sample.sampled_type) & int(mi.BSDFFlags.Delta):
                record["deltas"].append(
                    {
                        "wi": rounded(wi),
                        "u": pick,
                        "wo": rounded(sample.wo),
                        "weight": rounded(weight),
                        "pdf": rounded([sample.pdf])[0],
                        "eta": rounded([sample.eta])[0],
                    }
                )
    return record


def main():
    records = [describe(material) for material in MATERIALS]
    lines = ",\n".join(json.dumps(record) for record in records)
    print(f'{{"mitsuba": "{mi.__version__}", "records": [\n{lines}\n]}}')


main()
