"""Writes a neutral scene (neutral_scene.py) in LuxCore's scene description.

Knows diffuse and smooth conductors and dielectrics without textures, area lights and a constant sky. Anything else is
refused by name: a comparison on another scene than stated would be worthless. Diffuse surfaces reflect on both sides
here.
"""

from neutral_scene import Unsupported


def constant(value, where):
    if isinstance(value, dict):
        raise Unsupported(f"a texture as {where}")
    return [float(part) for part in value]


def material(entry):
    """Properties of a material, by the last part of their names."""
    kind = entry["kind"]
    if kind == "diffuse":
        return {"type": "matte", "kd": constant(entry["reflectance"], "reflectance")}
    if entry["alpha"]:
        raise Unsupported(f"bsdf 'rough{kind}'")
    if kind == "dielectric":
        return {"type": "glass", "kr": entry["reflectance"], "kt": entry["transmittance"], "interiorior": entry["eta"]}
    if entry["eta"] is None:
        return {"type": "mirror", "kr": entry["specular"]}
    raise Unsupported("bsdf 'conductor' with 'eta' and 'k'")


def light(entry):
    """Properties of a light without a shape."""
    if entry["kind"] == "constant":
        return {"type": "constantinfinite", "color": entry["radiance"]}
    raise Unsupported(f"emitter '{entry['kind']}'")


def camera(entry):
    """LuxCore measures the field of view along the larger side of the film."""
    matrix = entry.to_world
    origin, forward, up = matrix[:3, 3], matrix[:3, 2], matrix[:3, 1]
    return {
        "type": "perspective",
        "lookat.orig": origin.tolist(),
        "lookat.target": (origin + forward).tolist(),
        "up": up.tolist(),
        "fieldofview": entry.fov_larger(),
        "cliphither": entry.near,
        "clipyon": entry.far,
        "autofocus.enable": False,
    }


def convert(scene):
    """Property names and values of the scene, for Scene.Parse. Raises Unsupported."""
    settings = {f"scene.camera.{name}": value for name, value in camera(scene.camera).items()}
    for index, entry in enumerate(scene.lights):
        settings |= {f"scene.lights.l{index}.{name}": value for name, value in light(entry).items()}
    for index, mesh in enumerate(scene.meshes):
        properties = material(scene.materials[mesh.material])
        if mesh.emission is not None:
            properties["emission"] = constant(mesh.emission, "radiance")
        settings |= {f"scene.materials.m{index}.{name}": value for name, value in properties.items()}
        item = f"scene.objects.o{index}"
        settings[f"{item}.material"] = f"m{index}"
        settings[f"{item}.vertices"] = mesh.vertices.ravel().tolist()
        settings[f"{item}.faces"] = mesh.triangles.ravel().tolist()
        if mesh.normals is not None:
            settings[f"{item}.normals"] = mesh.normals.ravel().tolist()
    return settings
