"""A page for each plugin of the scene language: what it is, its parameters with their defaults, what differs from Mitsuba, and
pictures. In: scenes/plugins.json, which a test holds against the loader. Out: pages below `language`."""

import html
import json

from pictures import ROOT, first_sentence

SOURCE = ROOT / "scenes/plugins.json"


def pictures_of(entry):
    """The pictures of a plugin's entry: {"scene": ..., "options": ..., "caption": ...}, the latter two optional."""
    return entry["pictures"] if "pictures" in entry else [{"scene": entry["scene"]}]


def page_name(object_tag, plugin):
    return f"{object_tag}-{plugin if plugin != '*' else 'any'}.md"


def plugin_page(object_tag, plugin, entry, groups, pictures):
    head = f"# {plugin}\n\n" if plugin != "*" else f"# Any {object_tag}\n\n"
    text = head + f"`<{object_tag} type=\"{plugin if plugin != '*' else '...'}\">` {entry['summary']}\n\n"
    figures = ""
    for picture in pictures_of(entry):
        scene, options = picture["scene"], picture.get("options", "")
        source = f"<code>{scene}{' ' + html.escape(options) if options else ''}</code>"
        caption = html.escape(picture.get("caption") or first_sentence(scene))
        figures += pictures.figure(scene, options, f"{caption} {source}", "../pictures")
    text += f'<div class="pictures">\n{figures}</div>\n' if figures else ""
    parameters = dict(entry.get("parameters", {}))
    for group in entry.get("uses", []):
        parameters = {**groups[group], **parameters}
    if parameters:
        text += "\n| parameter | type | default | |\n|---|---|---|---|\n"
        for name, about in sorted(parameters.items()):
            text += f"| `{name}` | {about['kind']} | {about['default']} | {about['meaning']} |\n"
    else:
        text += "\nIt has no parameters.\n"
    if "differs" in entry:
        text += f"\n**Other than in Mitsuba 3.** {entry['differs']}\n"
    return text


def language_pages(pages, pictures):
    """Writes the pages; returns title and name of their index, and nothing where the tree has no list of plugins."""
    if not SOURCE.exists():
        return []
    reference = json.loads(SOURCE.read_text())
    folder = pages / "language"
    folder.mkdir(parents=True)
    index = "# Scene language\n\nWhat the loader reads of Mitsuba's scene files; [scenes](../scenes/README.md) says how.\n"
    for object_tag, plugins in reference["plugins"].items():
        index += f"\n## {object_tag}\n\n| | |\n|---|---|\n"
        for plugin, entry in plugins.items():
            name = page_name(object_tag, plugin)
            (folder / name).write_text(plugin_page(object_tag, plugin, entry, reference["groups"], pictures))
            index += f"| [{plugin if plugin != '*' else 'any'}]({name}) | {entry['summary']} |\n"
    (folder / "index.md").write_text(index)
    return [("Plugins and parameters", "language/index.md")]
