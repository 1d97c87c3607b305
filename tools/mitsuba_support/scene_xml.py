"""Makes one self-standing XML text of a scene file: includes inlined, $variables kept with chosen defaults, paths absolute.

So a scene can be given a film size (and, on request, another reconstruction filter) without touching its file, and two
programs can be handed literally the same text wherever it is stored.
"""

import pathlib
import re
import xml.etree.ElementTree as ElementTree


def flatten(path, size=None, box_filter=False, defaults=None):
    """The scene as XML text.

    size        (width, height) to write into the film, None to keep what is there
    box_filter  True replaces the film's reconstruction filter by a box of one pixel
    defaults    values for the scene's <default> entries, by name
    Raises ValueError where the scene has no such entry.
    """
    path = pathlib.Path(path).resolve()
    root = _read(path, [path.parent])
    for name, value in (defaults or {}).items():
        entries = [entry for entry in root.iter("default") if entry.get("name") == name]
        if not entries:
            raise ValueError(f"{path}: no <default name='{name}'>; expected one to set")
        for entry in entries:
            entry.set("value", str(value))
    _resolve_names_with_variables(root, path.parent)
    if size or box_filter:
        film = root.find(".//film")
        if film is None:
            raise ValueError(f"{path}: no <film>; expected one in the scene or its includes")
        for name, value in zip(("width", "height"), size or ()):
            _set_integer(film, name, value)
        if box_filter:
            for old in film.findall("rfilter"):
                film.remove(old)
            ElementTree.SubElement(film, "rfilter", {"type": "box"})
    return ElementTree.tostring(root, encoding="unicode")


def filter_type(xml_text):
    """The type of the film's reconstruction filter; Mitsuba's default where none is given."""
    entry = ElementTree.fromstring(xml_text).find(".//film/rfilter")
    return "gaussian" if entry is None else entry.get("type")


def max_depth(xml_text):
    """Of the scene's integrator, also by a variable's default; -1, unlimited, where it says none."""
    root = ElementTree.fromstring(xml_text)
    entry = root.find("integrator/integer[@name='max_depth']")
    return -1 if entry is None else int(_with_defaults(entry.get("value"), root))


def hides_emitters(xml_text):
    """Whether the scene's integrator leaves out what rays from the camera see of lights."""
    entries = ElementTree.fromstring(xml_text).findall(".//integrator/boolean[@name='hide_emitters']")
    return any(entry.get("value") == "true" for entry in entries)


def _with_defaults(text, root):
    """The text with the values of the scene's <default> entries in place of $names."""
    values = {entry.get("name"): entry.get("value") for entry in root.iter("default")}
    return re.sub(r"\$\{?(\w+)\}?", lambda found: values.get(found[1], found[0]), text)


def _resolve_names_with_variables(root, *folders):
    """Makes file names such as assets/$sun.exr absolute, by the values of the variables in them."""
    for entry in root.iter("string"):
        name = entry.get("value", "")
        if entry.get("name") == "filename" and "$" in name.lstrip("$"):
            entry.set("value", _absolute(_with_defaults(name, root), *folders))


def _set_integer(parent, name, value):
    for entry in parent.findall("integer"):
        if entry.get("name") == name:
            entry.set("value", str(value))
            return
    ElementTree.SubElement(parent, "integer", {"name": name, "value": str(value)})


def _read(path, folders):
    """The file's root with absolute file names, looked for beside the file and in the folders of <path> elements."""
    root = ElementTree.parse(path).getroot()
    for entry in root.findall("path"):  # relative to the file that it stands in, as Mitsuba has it
        folders.append((path.parent / entry.get("value")).resolve())
        root.remove(entry)
    for entry in root.iter("string"):
        if entry.get("name") == "filename":
            entry.set("value", _absolute(entry.get("value"), path.parent, *folders))
    for entry in root.iter("default"):  # of a variable that stands for a file name
        if any((folder / entry.get("value")).is_file() for folder in (path.parent, *folders)):
            entry.set("value", _absolute(entry.get("value"), path.parent, *folders))
    _inline_includes(root, path, folders)
    return root


def _inline_includes(parent, path, folders):
    index = 0
    while index < len(parent):
        child = parent[index]
        if child.tag != "include":
            _inline_includes(child, path, folders)
            index += 1
            continue
        included = _read(pathlib.Path(_absolute(child.get("filename"), path.parent, *folders)), folders)
        parent.remove(child)
        for offset, element in enumerate(included):
            parent.insert(index + offset, element)
        index += len(included)


def _absolute(name, *folders):
    if name.startswith("$"):
        return name
    for folder in folders:
        if (folder / name).exists():
            return str((folder / name).resolve())
    return name
