"""Builds a neutral scene (neutral_scene.py) in Blender's data, as Cycles is to render it.

Coordinates stay as they are: Cycles does not mind where up is, only environment maps are turned. A texture is an image
whose row 0 is at v = 1 here, hence 1 - v. BSDFs of one side are black from behind where a mesh is open, as in Mitsuba;
so is emission.
"""

import math

import bpy
import mathutils
import numpy as np

from neutral_scene import Unsupported

EXTENSIONS = {"repeat": "REPEAT", "clamp": "EXTEND", "mirror": "MIRROR"}
DISTRIBUTIONS = {"ggx": "GGX", "beckmann": "BECKMANN"}
# Mitsuba's environment has y up and azimuth from -z over +x; that of Cycles z up and azimuth from -x over -y.
ENVIRONMENT_AXES = np.array([[0, 0, 1], [1, 0, 0], [0, 1, 0]])


def is_black(value):
    return not isinstance(value, dict) and max(value) == 0


def is_open(mesh):
    """Whether an edge belongs to one triangle alone, by position."""
    _, places = np.unique(mesh.vertices.round(6), axis=0, return_inverse=True)
    corners = places.reshape(-1)[mesh.triangles]
    edges = np.sort(np.concatenate([corners[:, [a, b]] for a, b in ((0, 1), (1, 2), (2, 0))]), axis=1)
    return bool((np.unique(edges, axis=0, return_counts=True)[1] % 2).any())


class Shader:
    """The node tree of a material or world."""

    def __init__(self, owner):
        owner.use_nodes = True
        self.tree = owner.node_tree
        self.tree.nodes.clear()

    def node(self, kind, inputs=(), **settings):
        """A new node; inputs by name or place: a socket to link, or a value."""
        result = self.tree.nodes.new("ShaderNode" + kind)
        for name, value in settings.items():
            setattr(result, name, value)
        for name, value in dict(inputs).items():
            if isinstance(value, bpy.types.NodeSocket):
                self.tree.links.new(value, result.inputs[name])
            elif isinstance(value, (list, tuple)) and result.inputs[name].type == "RGBA":
                result.inputs[name].default_value = (*value, 1)
            else:
                result.inputs[name].default_value = value
        return result

    def color(self, value):
        """A colour, or a socket that has the texture's."""
        if not isinstance(value, dict):
            return value
        if value["texture"] == "checkerboard":
            image = checkerboard(value["colors"])
            node = self.node("TexImage", interpolation="Closest", extension="REPEAT")
        else:
            image = bpy.data.images.load(value["file"], check_existing=True)
            is_linear = value["raw"] or value["file"].lower().endswith((".exr", ".hdr", ".pfm"))
            image.colorspace_settings.name = "Non-Color" if is_linear else "sRGB"
            interpolation = "Closest" if value["nearest"] else "Linear"
            node = self.node("TexImage", interpolation=interpolation, extension=EXTENSIONS[value["wrap"]])
        node.image = image
        return node.outputs["Color"]

    def front_only(self, shader):
        """The shader in front, nothing behind."""
        back = self.node("NewGeometry").outputs["Backfacing"]
        return self.node("MixShader", {0: back, 1: shader}).outputs[0]

    def finish(self, shader, kind="OutputMaterial"):
        self.node(kind, {"Surface": shader})


def checkerboard(colors):
    image = bpy.data.images.new("checkerboard", 2, 2, float_buffer=True)
    image.colorspace_settings.name = "Non-Color"
    even, odd = ((*color, 1) for color in colors)
    image.pixels.foreach_set(np.array([even, odd, odd, even], np.float32).ravel())
    image.pack()
    return image


def diffuse(shader, material):
    return shader.node("BsdfDiffuse", {"Color": shader.color(material["reflectance"])}).outputs[0]


def conductor(shader, material):
    roughness = math.sqrt(material["alpha"])  # Cycles squares it
    distribution = DISTRIBUTIONS[material["distribution"]]
    if material["eta"] is None:
        inputs = {"Color": material["specular"], "Roughness": roughness}
        return shader.node("BsdfAnisotropic", inputs, distribution=distribution).outputs[0]
    inputs = {"IOR": material["eta"], "Extinction": material["k"], "Roughness": roughness}
    fresnel = {"distribution": distribution, "fresnel_type": "PHYSICAL_CONDUCTOR"}
    metal = shader.node("BsdfMetallic", inputs, **fresnel).outputs[0]
    scale = material["specular"]
    if min(scale) != max(scale):
        raise Unsupported("a coloured 'specular_reflectance' of a conductor")
    return metal if scale[0] == 1 else shader.node("MixShader", {0: 1 - scale[0], 1: metal}).outputs[0]


def dielectric(shader, material):
    roughness, eta = math.sqrt(material["alpha"]), material["eta"]
    settings = {"distribution": DISTRIBUTIONS[material["distribution"]]}
    if material["reflectance"] == material["transmittance"] == [1, 1, 1]:
        inputs = {"Color": [1, 1, 1], "IOR": eta, "Roughness": roughness}
        return shader.node("BsdfGlass", inputs, **settings).outputs[0]
    if roughness:
        raise Unsupported("a tinted 'roughdielectric'")
    reflected = shader.node("BsdfAnisotropic", {"Color": material["reflectance"], "Roughness": 0.0}, **settings)
    inputs = {"Color": material["transmittance"], "IOR": eta, "Roughness": 0.0}
    refracted = shader.node("BsdfRefraction", inputs, **settings)
    fresnel = shader.node("Fresnel", {"IOR": eta})
    return shader.node("MixShader", {0: fresnel.outputs[0], 1: refracted.outputs[0], 2: reflected.outputs[0]}).outputs[
        0
    ]


KINDS = {"diffuse": diffuse, "conductor": conductor, "dielectric": dielectric}


def surface(mesh, material):
    """A Blender material of a mesh: its BSDF and, of an emitter, its light."""
    result = bpy.data.materials.new("material")
    shader = Shader(result)
    outputs = []
    is_dark = is_black(material.get("reflectance", [1])) and material["kind"] == "diffuse"
    if not is_dark:
        bsdf = KINDS[material["kind"]](shader, material)
        outputs.append(bsdf if material["two_sided"] or not is_open(mesh) else shader.front_only(bsdf))
    if mesh.emission is not None:
        light = shader.node("Emission", {"Color": shader.color(mesh.emission), "Strength": 1.0}).outputs[0]
        result.cycles.emission_sampling = "FRONT"
        outputs.append(shader.front_only(light))
    if len(outputs) == 2:
        outputs = [shader.node("AddShader", {0: outputs[0], 1: outputs[1]}).outputs[0]]
    if outputs:
        shader.finish(outputs[0])
    return result


def add_mesh(mesh, materials):
    data = bpy.data.meshes.new("mesh")
    count = len(mesh.triangles)
    corners = np.ascontiguousarray(mesh.triangles, np.int32).ravel()
    data.vertices.add(len(mesh.vertices))
    data.vertices.foreach_set("co", mesh.vertices.astype(np.float32).ravel())
    data.loops.add(3 * count)
    data.loops.foreach_set("vertex_index", corners)
    data.polygons.add(count)
    data.polygons.foreach_set("loop_start", np.arange(0, 3 * count, 3, dtype=np.int32))
    if mesh.uv is not None:
        uv = np.column_stack([mesh.uv[:, 0], 1 - mesh.uv[:, 1]]).astype(np.float32)
        data.uv_layers.new(name="uv").data.foreach_set("uv", uv[corners].ravel())
    data.update(calc_edges=True)
    if mesh.normals is None:
        data.shade_flat()
    else:
        data.shade_smooth()
        data.normals_split_custom_set_from_vertices(mesh.normals)
    data.materials.append(surface(mesh, materials[mesh.material]))
    item = bpy.data.objects.new("mesh", data)
    item.cycles.shadow_terminator_geometry_offset = 0
    bpy.context.scene.collection.objects.link(item)


def add_world(light):
    world = bpy.context.scene.world = bpy.data.worlds.new("world")
    shader = Shader(world)
    if light["kind"] == "constant":
        color, strength = light["radiance"], 1.0
    else:
        to_local = ENVIRONMENT_AXES @ np.linalg.inv(np.array(light["to_world"])[:3, :3])
        euler = mathutils.Matrix(to_local.tolist()).to_euler()
        direction = shader.node("TexCoord").outputs["Generated"]
        turned = shader.node("Mapping", {"Vector": direction, "Rotation": euler}, vector_type="POINT").outputs[0]
        image = bpy.data.images.load(light["file"])
        image.colorspace_settings.name = "Non-Color"
        texture = shader.node("TexEnvironment", {"Vector": turned})
        texture.image = image
        color, strength = texture.outputs["Color"], light["scale"]
    shader.finish(shader.node("Background", {"Color": color, "Strength": strength}).outputs[0], "OutputWorld")


def add_light(light):
    """A sun without size, or a point. Blender's watts of a point are 4 pi times its intensity."""
    is_sun = light["kind"] == "directional"
    color = light["irradiance" if is_sun else "intensity"]
    data = bpy.data.lights.new("light", "SUN" if is_sun else "POINT")
    data.energy = max(color) * (1 if is_sun else 4 * math.pi)
    data.color = [value / max(color) for value in color]
    item = bpy.data.objects.new("light", data)
    if is_sun:
        data.angle = 0
        item.rotation_euler = mathutils.Vector(light["direction"]).to_track_quat("-Z", "Y").to_euler()
    else:
        data.shadow_soft_size = 0
        item.location = light["position"]
    bpy.context.scene.collection.objects.link(item)


def add_camera(camera):
    data = bpy.data.cameras.new("camera")
    data.sensor_fit, data.lens_unit = "HORIZONTAL", "FOV"
    data.angle = math.radians(camera.fov_x)
    data.clip_start, data.clip_end = camera.near, camera.far
    item = bpy.data.objects.new("camera", data)
    # Blender's camera looks along -z and has +x on the right.
    item.matrix_world = mathutils.Matrix((camera.to_world @ np.diag([-1, 1, -1, 1])).tolist())
    bpy.context.scene.collection.objects.link(item)
    bpy.context.scene.camera = item


def build(scene):
    """Replaces Blender's data by the scene. Raises Unsupported."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    for mesh in scene.meshes:
        add_mesh(mesh, scene.materials)
    for light in scene.lights:
        (add_world if light["kind"] in ("constant", "envmap") else add_light)(light)
    add_camera(scene.camera)
