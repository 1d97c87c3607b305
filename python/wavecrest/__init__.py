"""wavecrest renders scenes by several light-transport methods and measures how fast each converges.

>>> import wavecrest as wc
>>> scene = wc.load("cornell-mirror", width=256)
>>> r = scene.render("vcm", time="10s")
>>> r.image.shape
(192, 256, 3)
"""

from wavecrest import metrics
from wavecrest._native import commit as __commit__
from wavecrest._native import version as __version__
from wavecrest.arrays import read_image
from wavecrest.campaign import Results, converge, read_results
from wavecrest.comparison import Comparison, Reference, Score, compare
from wavecrest.errors import Error, FaultError, InputError, Interrupted, UsageError
from wavecrest.render import Inspection, Result, Scene, load, scene_folder, scenes
from wavecrest.tables import Table

__all__ = [
    "Comparison",
    "Error",
    "FaultError",
    "InputError",
    "Inspection",
    "Interrupted",
    "Reference",
    "Result",
    "Results",
    "Scene",
    "Score",
    "Table",
    "UsageError",
    "__commit__",
    "__version__",
    "compare",
    "converge",
    "load",
    "metrics",
    "read_image",
    "read_results",
    "scene_folder",
    "scenes",
]
