"""Each plugin of scenes/plugins.json, which is held against the loader's own list, has a picture of a scene that has it."""

import json
import pathlib
import re
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "docs"))

from language_pages import pictures_of  # noqa: E402
from pictures import first_sentence  # noqa: E402


def plugins_of(scene, options):
    """Pairs (object, plugin) of a scene's file and of the files that it includes, with the variables that the options set."""
    text = scene.read_text()
    for included in re.findall(r'<include filename="([^"]+)"', text):
        text += (scene.parent / included).read_text()
    values = dict(re.findall(r'<default name="(\w+)" value="([^"]*)"', text)) | dict(re.findall(r"-D (\w+)=(\S+)", options))
    found = re.findall(r'<(\w+) (?:[^<>]*\s)?type="([^"]+)"', text)
    return {(tag, values[plugin[1:]] if plugin.startswith("$") else plugin) for tag, plugin in found}


def without_picture(plugins):
    """The plugins that are in no scene of their pictures."""
    lacking = []
    for tag, entries in plugins.items():
        for plugin, entry in entries.items():
            shown = set()
            for picture in pictures_of(entry) if "pictures" in entry or "scene" in entry else []:
                shown |= plugins_of(ROOT / picture["scene"], picture.get("options", ""))
            if not any(pair == (tag, plugin) or plugin == "*" and pair[0] == tag for pair in shown):
                lacking.append(f"{tag} {plugin}")
    return lacking


class PluginPictures(unittest.TestCase):
    def setUp(self):
        self.plugins = json.loads((ROOT / "scenes/plugins.json").read_text())["plugins"]

    def test_each_plugin_has_one(self):
        self.assertGreater(sum(map(len, self.plugins.values())), 50)
        self.assertEqual(without_picture(self.plugins), [])

    def test_a_plugin_without_one_is_found(self):
        matt = "scenes/features/point.xml"
        plugins = {"bsdf": {"diffuse": {"scene": matt}, "phong": {"scene": matt}, "ward": {}}, "sampler": {"*": {"scene": matt}}}
        self.assertEqual(without_picture(plugins), ["bsdf phong", "bsdf ward"])
        shape = {"scene": "scenes/plugins/shape.xml", "options": "-D shape=disk"}
        self.assertEqual(without_picture({"shape": {"disk": {"pictures": [shape]}, "cube": {"pictures": [shape]}}}), ["shape cube"])

    def test_each_picture_says_what_it_shows(self):
        for entries in self.plugins.values():
            for entry in entries.values():
                for picture in pictures_of(entry):
                    self.assertTrue(picture.get("caption") or first_sentence(picture["scene"]), picture)


if __name__ == "__main__":
    unittest.main()
