"""BSDFs and textures of flat Mitsuba XML as the dictionaries that neutral_scene.py describes."""

import numpy as np

import neutral_xml as xml
from neutral_scene import Unsupported

WRAPS = ("repeat", "clamp", "mirror")


class Materials:
    """The materials of one scene, in the order in which shapes ask for them."""

    def __init__(self, root):
        self.named = {entry.get("id"): entry for entry in root if entry.get("id")}
        self.entries, self.uv_transforms, self.places = [], [], {}

    def of(self, parent):
        """Index of the material of a <shape>: its <bsdf>, or the one that its <ref> names."""
        bsdf = parent.find("bsdf")
        for reference in parent.findall("ref"):
            if bsdf is None and (named := self.named.get(reference.get("id"))) is not None and named.tag == "bsdf":
                bsdf = named
        if bsdf is not None and id(bsdf) in self.places:
            return self.places[id(bsdf)]
        reader = Reader(self.named)
        if bsdf is None:
            entry = {"kind": "diffuse", "two_sided": False, "reflectance": [0.5] * 3}
        else:
            entry = reader.bsdf(bsdf)
        self.entries.append(entry)
        self.uv_transforms.append(reader.to_uv)
        self.places[id(bsdf)] = len(self.entries) - 1
        return len(self.entries) - 1

    def emission(self, emitter):
        """Radiance of an area emitter (a value), and the transform of its texture, or None."""
        reader = Reader(self.named)
        return reader.value(emitter, "radiance", 1), reader.to_uv


class Reader:
    """Reads one BSDF; to_uv is the transform of its texture, 4 x 4, or None where it has none."""

    def __init__(self, named):
        self.named, self.to_uv = named, None

    def bsdf(self, element):
        kind = element.get("type")
        if kind == "twosided":
            inner = [self._resolve(entry) for entry in element if entry.tag in ("bsdf", "ref")]
            if len(inner) != 1:
                raise Unsupported("bsdf 'twosided' with another bsdf on each side")
            return {**self.bsdf(inner[0]), "two_sided": True}
        if kind == "diffuse":
            return {"kind": kind, "two_sided": False, "reflectance": self.value(element, "reflectance", 0.5)}
        if kind in ("conductor", "roughconductor"):
            return {"kind": "conductor", "two_sided": False, **self._roughness(element), **self._conductor(element)}
        if kind in ("dielectric", "roughdielectric"):
            return {"kind": "dielectric", "two_sided": True, **self._roughness(element), **self._dielectric(element)}
        raise Unsupported(f"bsdf '{kind}'")

    def value(self, parent, name, default):
        """A colour or a texture; see neutral_scene.py."""
        for element in parent:
            if element.get("name") != name:
                continue
            element = self._resolve(element)
            if element.tag in ("rgb", "float", "spectrum"):
                try:
                    parsed = xml.numbers(element.get("value") or "")
                except ValueError:
                    parsed = []
                if len(parsed) in (1, 3):
                    return parsed * 3 if len(parsed) == 1 else parsed
            if element.tag == "texture":
                return self._texture(element)
            raise Unsupported(
                f"'{name}' of <{parent.tag} type='{parent.get('type')}'> is not an rgb value or a texture"
            )
        return [default] * 3

    def color(self, parent, name, default):
        value = self.value(parent, name, default)
        if isinstance(value, dict):
            raise Unsupported(f"a texture as '{name}' of bsdf '{parent.get('type')}'")
        return value

    def _resolve(self, element):
        if element.tag != "ref":
            return element
        if element.get("id") not in self.named:
            raise Unsupported(f"<ref id='{element.get('id')}'>")
        return self.named[element.get("id")]

    def _texture(self, element):
        kind = element.get("type")
        to_uv = xml.transform(element, "to_uv")
        if self.to_uv is not None and not np.array_equal(to_uv, self.to_uv):
            raise Unsupported("textures of two transforms on one shape")
        self.to_uv = to_uv
        if kind == "checkerboard":
            return {"texture": kind, "colors": [self.color(element, "color0", 0.4), self.color(element, "color1", 0.2)]}
        wrap = xml.text(element, "wrap_mode", "repeat")
        if kind != "bitmap" or wrap not in WRAPS or xml.text(element, "filename") is None:
            raise Unsupported(f"texture '{kind}'" if kind != "bitmap" else f"wrap_mode '{wrap}'")
        nearest = xml.text(element, "filter_type", "bilinear") == "nearest"
        file, raw = xml.text(element, "filename"), xml.flag(element, "raw")
        return {"texture": kind, "file": file, "raw": raw, "nearest": nearest, "wrap": wrap}

    def _roughness(self, element):
        distribution = xml.text(element, "distribution", "beckmann")
        if not element.get("type").startswith("rough"):
            return {"alpha": 0, "distribution": "ggx"}
        if any(entry.get("name", "").startswith("alpha") and entry.tag == "texture" for entry in element):
            raise Unsupported(f"a texture as roughness of bsdf '{element.get('type')}'")
        alpha_u, alpha_v = (xml.number(element, f"alpha_{axis}", xml.number(element, "alpha", 0.1)) for axis in "uv")
        if alpha_u != alpha_v:
            raise Unsupported(f"anisotropic bsdf '{element.get('type')}'")
        return {"alpha": alpha_u, "distribution": distribution}

    def _conductor(self, element):
        result = {"eta": None, "k": None, "specular": self.color(element, "specular_reflectance", 1)}
        material = xml.text(element, "material", "none")
        if any(entry.get("name") in ("eta", "k") for entry in element):
            return {**result, "eta": self.color(element, "eta", 0), "k": self.color(element, "k", 1)}
        if material == "none":
            return result
        parameters = _mitsuba_parameters({"type": "conductor", "material": material})
        return {**result, **{name: [float(x) for x in parameters[f"{name}.value"]] for name in ("eta", "k")}}

    def _dielectric(self, element):
        words = {"type": "dielectric", "int_ior": "bk7", "ext_ior": "air"}
        for name in ("int_ior", "ext_ior"):
            words[name] = xml.number(element, name, xml.text(element, name, words[name]))
        tints = {name: self.color(element, f"specular_{name}", 1) for name in ("reflectance", "transmittance")}
        return {"eta": float(_mitsuba_parameters(words)["eta"]), **tints}


def _mitsuba_parameters(words):
    """What Mitsuba makes of the names of materials."""
    import mitsuba

    return mitsuba.traverse(mitsuba.load_dict(words))
