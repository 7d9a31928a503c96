"""python-can's own tests of a back end, run against the interface `odkit`."""

import subprocess
import sys
import tarfile

import can
import pytest

#: The tests are in the source package alone, which is fetched.
TESTS = '''
import unittest

import can
from test import back2back_test


class Odkit:
    TIME = None

    def setUp(self):
        arguments = {"interface": "odkit", "channel": "back=", "time": self.TIME}
        self.bus1 = can.Bus(**arguments)
        self.bus2 = can.Bus(**arguments)

    def test_unique_message_instances(self):
        arguments = {"interface": "odkit", "channel": "back", "receive_own_messages": True}
        opened = back2back_test.can.Bus
        back2back_test.can.Bus = lambda **_: opened(**arguments)
        try:
            super().test_unique_message_instances()
        finally:
            back2back_test.can.Bus = opened

    @unittest.skip("odkit does not support CAN FD")
    def test_fd_message(self):
        pass

    @unittest.skip("odkit does not support CAN FD")
    def test_fd_message_with_brs(self):
        pass


class Virtual(Odkit, back2back_test.Back2BackTestCase):
    @unittest.skip("time is virtual: it begins at 0")
    def test_timestamp_is_absolute(self):
        pass

    @unittest.skip("time is virtual: nobody waits in `time.sleep`")
    def test_timestamp(self):
        pass

    @unittest.skip("time is virtual: nobody waits in `time.sleep`")
    def test_sub_second_timestamp_resolution(self):
        pass


class Real(Odkit, back2back_test.Back2BackTestCase):
    TIME = "real"
'''


@pytest.mark.long
def test_back_to_back(tmp_path):
    package = f"python-can=={can.__version__}"
    fetch = [sys.executable, "-m", "pip", "download", "--quiet", "--no-deps", "--no-binary", "python-can"]
    subprocess.run([*fetch, package], cwd=tmp_path, check=True)
    (archive,) = tmp_path.glob("*.tar.gz")
    with tarfile.open(archive) as source:
        wanted = [one for one in source if one.name.split("/", 1)[-1] in ("test/back2back_test.py", "test/config.py")]
        source.extractall(tmp_path, wanted)
    (folder,) = (one for one in tmp_path.iterdir() if one.is_dir())
    (folder / "test/__init__.py").touch()
    (folder / "test_odkit.py").write_text(TESTS)
    command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", "test_odkit.py"]
    command += ["--override-ini", "addopts=", "--import-mode=prepend"]
    done = subprocess.run(command, cwd=folder, stdout=subprocess.PIPE, text=True)
    assert done.returncode == 0, done.stdout
