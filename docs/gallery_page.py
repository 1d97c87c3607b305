"""The gallery: the nine scenes and the feature scenes, each with a picture, one sentence and the command that makes it."""

import html

from pictures import ROOT, first_sentence, words

# Of each of the nine, a method that shows all of its light within a few seconds.
NINE = {
    "cornell-diffuse": "-m bpt --spp 128",
    "cornell-mirror": "-m vcm --spp 128",
    "cornell-glossy": "-m vcm --spp 64",
    "cornell-spheres": "-m vcm --spp 128",
    "dragon-caustics": "-m vcm --spp 48",
    "dragon-caustics-glossy": "-m vcm --spp 48",
    "lafortune-room": "-m ppm --spp 64",
    "pool-interior": "-m ppm --spp 64",
    "veach-door": "-m ppm --spp 64",
}
# Of feature scenes that need other options than the rest.
FEATURES = {
    "frosted-lamp": "-m vcm --spp 64",
    "slit": "-m ppm --spp 64",
}


def entry(pictures, scene, name, options):
    """The figure of a scene, as HTML. name: the scene in the command below it."""
    command = ["wavecrest", "render", name, *words(options), "-o", name.rsplit("/")[-1].removesuffix(".xml") + ".png"]
    shown = " ".join(f"<span>{word}</span>" for word in command)  # lines end between words
    figure = pictures.figure(scene, options, f"{html.escape(first_sentence(scene))}\n<pre><code>{shown}</code></pre>", "pictures")
    if figure:
        return figure
    return f"<figure><figcaption>{html.escape(name)}: no picture, as its model was not fetched (scenes/fetch-dragon).</figcaption></figure>\n"


def gallery_page(pages, pictures):
    """Writes the page; returns its title and name, and nothing without a program or in a tree without the scenes."""
    if not pictures.program or not (ROOT / "scenes/features").exists():
        return []
    text = "# Gallery\n\nEach picture is what its command makes, run at the top of the source tree, in a few seconds. "
    text += "[Scenes](scenes/README.md) says what each of the nine is hard for.\n\n"
    text += '## The nine scenes\n\n<div class="pictures">\n'
    for name, options in NINE.items():
        text += entry(pictures, f"scenes/{name}.xml", name, options)
    text += "</div>\n\n## Feature scenes\n\nOne BSDF, texture, light, sensor or filter each, for tests against Mitsuba 3.\n\n"
    text += '<div class="pictures">\n'
    for file in sorted((ROOT / "scenes/features").glob("*.xml")):
        scene = f"scenes/features/{file.name}"
        text += entry(pictures, scene, scene, FEATURES.get(file.stem, ""))
    (pages / "gallery.md").write_text(text + "</div>\n")
    return [("Gallery", "gallery.md")]
