"""python-canopen and `odkit get` read the same values of the same node."""

import json
import subprocess

import canopen

from bench import EDS, BenchCase, odkit
from test_objects import variables

# Values that change between two reads.
LIVE = {(0x2201, 1), (0x2201, 2)}


class Same(BenchCase):
    def test_every_value_is_the_same(self):
        sim = self.sim("gxmm")
        node = sim.node()
        read = {}
        for variable in variables(node.object_dictionary):
            address = (variable.index, variable.subindex)
            if not variable.readable or address in LIVE:
                continue
            try:
                read[address] = node.sdo.upload(*address).hex(" ").upper()
            except canopen.SdoAbortedError as error:
                read[address] = f"{error.code:08X}h"
        sim.leave()
        link = f"slcan:127.0.0.1:{sim.port}"
        command = [odkit(), "get", "1", "*", "--eds", EDS, "--link", link, "--format", "json"]
        done = subprocess.run(command, stdout=subprocess.PIPE, check=False, text=True)
        values = {(one["index"], one["sub"]): one for one in json.loads(done.stdout)["values"]}
        self.assertGreater(len(read), 80)
        for address, value in read.items():
            own = values[address]
            self.assertEqual(own.get("bytes", own.get("abort")), value, f"{own}")
