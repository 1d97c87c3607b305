"""A ReFrame test: wavecrest's throughput on a cluster's nodes, one run for each scene and method.

    reframe -c bench/integrations/reframe_wavecrest.py -r -S wavecrest=/path/to/wavecrest

The binary is found on PATH unless -S says where. ReFrame's own settings say which systems and environments there are;
references for a system go into a site's subclass.
"""

import json
import os

import reframe as rfm
import reframe.utility.sanity as sn
from reframe.core.builtins import parameter, performance_function, run_before, sanity_function, variable


@rfm.simple_test
class WavecrestThroughput(rfm.RunOnlyRegressionTest):
    """Paths per second of a method, on all cores and per core."""

    descr = "paths per second of a light-transport method"
    valid_systems = ["*"]
    valid_prog_environs = ["*"]
    scene = parameter(["cornell-diffuse", "dragon-caustics", "lafortune-room"])
    method = parameter(["pt", "bpt", "vcm"])
    wavecrest = variable(str, value="wavecrest")
    duration = variable(str, value="30s")
    exclusive_access = True

    @run_before("run")
    def set_command(self):
        """All hardware threads of a node in one process."""
        self.executable = self.wavecrest
        self.executable_opts = [
            "bench", self.scene, "--methods", self.method, "--duration", self.duration, "--json", "result.json",
        ]

    def figures(self):
        """The result that the run left in its stage folder."""
        with open(os.path.join(self.stagedir, "result.json"), encoding="utf-8") as file:
            return json.load(file)["scenes"][0]["methods"][0]

    @sanity_function
    def assert_result(self):
        """The run has ended and measured the method that was asked for."""
        return sn.assert_eq(sn.defer(self.figures()["method"]), self.method)

    @performance_function("paths/s")
    def paths_per_second(self):
        return self.figures()["paths_per_second"]

    @performance_function("paths/s")
    def paths_per_cpu_second(self):
        return self.figures()["paths_per_cpu_second"]

    @performance_function("ratio")
    def speedup(self):
        return self.figures()["scaling"][-1]["speedup"]
