"""The conformance test of a node as tests of pytest: ``--odkit-conform``."""

import pytest

import odkit


class Failed(Exception):
    """The node failed a case."""


class Node(pytest.Collector):
    """The node under test: its cases, in the order in which they are run."""

    def collect(self):
        option = self.config.getoption
        link, eds = option("--odkit-conform"), option("--odkit-eds")
        simulated = link[len("bench:") :] if link.startswith("bench:") else None
        if simulated is not None and "," in simulated:
            raise pytest.UsageError("--odkit-conform tests one node: write bench:DEVICE")
        if simulated is None and eds is None:
            raise pytest.UsageError("add --odkit-eds FILE: the EDS of the node")
        device, _, node = (simulated or "").partition("@")
        self.link, self.eds = link, eds or device
        self.node_id = option("--odkit-node-id") or (int(node) if node.isdigit() else 1)
        if simulated is not None and not node:
            self.link = f"{link}@{self.node_id}"
        #: A simulated device allows every case.
        self.may = [simulated is not None or option(f"--odkit-allow-{what}") for what in ("reset", "store", "motion")]
        try:
            cases = odkit.conform_cases(option("--odkit-only"))
        except ValueError as error:
            raise pytest.UsageError(str(error)) from None
        for case, group, clause, title in cases:
            yield Case.from_parent(self, name=f"{case}[{clause}]", case=case, title=title)

    def setup(self):
        """Opens the link before the first case; it is closed after the last one."""
        client = odkit.Client(self.link)
        self.addfinalizer(client.close)
        reset, store, motion = self.may
        self.test = odkit.Conform(
            client, self.node_id, self.eds, allow_reset=reset, allow_store=store, allow_motion=motion
        )


class Case(pytest.Item):
    """One case."""

    def __init__(self, *, case, title, **keywords):
        super().__init__(**keywords)
        self.case, self.title = case, title

    def runtest(self):
        record = self.parent.test.run(self.case)
        self.user_properties += [("clause", record.clause), ("title", record.title)]
        for note in record.notes:
            self.add_report_section("call", "note", note)
        if record.verdict == "fail":
            self.add_report_section("call", "odkit bus log", "\n".join(record.frames))
            raise Failed(f"{record.clause}: {record.title}\n{record.reason}")
        if record.verdict != "pass":
            pytest.skip(record.reason)

    def repr_failure(self, excinfo):
        if isinstance(excinfo.value, Failed):
            return str(excinfo.value)
        return super().repr_failure(excinfo)

    def reportinfo(self):
        return self.path, None, f"{self.name}: {self.title}"
