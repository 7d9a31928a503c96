"""The plugin of pytest, in a pytest of its own."""

import os
import socket

import pytest

pytest_plugins = ["pytester"]
EDS = os.path.abspath(os.path.join(os.path.dirname(__file__), "../../devices/eds/GXMM.eds"))


def test_fixtures(odkit_bench, odkit_bus):
    assert [device.name for device in odkit_bench.devices] == ["gxmm"]
    assert odkit_bus.recv(1) is None and odkit_bench.now == 1


@pytest.mark.odkit_devices("gxmm@1", "eam_mt@2")
def test_devices(odkit_bench):
    assert [device.node_id for device in odkit_bench.devices] == [1, 2]


@pytest.mark.odkit_eds("../../devices/eds/GXMM.eds", node_id=5)
def test_eds(odkit_bench):
    assert odkit_bench[5].name == "GXMM.eds"


def test_a_failing_test_shows_its_frames_and_all_are_recorded(pytester):
    pytester.makepyfile(
        test_it="""
        import pytest

        @pytest.mark.odkit_devices("gxmm@3")
        def test_fails(odkit_bench):
            odkit_bench.run(0.1)
            odkit_bench.expect("583#60 *", within=0.1)

        def test_passes(odkit_bench, odkit_bus):
            odkit_bench.expect("701#00")
        """
    )
    result = pytester.runpytest("--odkit-record", "logs")
    result.assert_outcomes(passed=1, failed=1)
    result.stdout.fnmatch_lines(
        ["*AssertionError: 583#60 [*] did not come within 0.1 s*", "*odkit bus log*", "0.000000 <- 703#00*boot-up*"]
    )
    logs = {path.name: path.read_text() for path in (pytester.path / "logs").iterdir()}
    assert logs["test_it.py-test_fails.log"] == "(0.000000) can0 703#00\n"
    assert set(logs) == {"test_it.py-test_fails.log", "test_it.py-test_passes.log"}


def test_a_failing_test_says_what_its_frames_show(pytester):
    pytester.makepyfile(
        """
        def test_restarts(odkit_bench):
            device = odkit_bench["gxmm"]
            device[0x1017] = 100
            for _ in range(3):
                odkit_bench.run(1)
                device.power = False
                odkit_bench.run(0.5)
                device.power = True
            odkit_bench.run(1)
            incidents = odkit_bench.diagnose()
            assert [incident.rule for incident in incidents] == ["reboots"]
            assert incidents[0].nodes == [1] and incidents[0].causes and incidents[0].frames
            assert False

        def test_healthy(odkit_bench):
            odkit_bench.run(5)
            assert odkit_bench.diagnose() == []
            assert False
        """
    )
    result = pytester.runpytest()
    result.assert_outcomes(failed=2)
    result.stdout.fnmatch_lines(["*odkit diagnosis*", "node 1 restarts 3 times*", "cause 1: *", "*check *", "*boot-up*", "*odkit bus log*"])
    assert result.stdout.str().count("odkit diagnosis") == 1


def test_the_conformance_test_of_a_node(pytester):
    pytester.makepyfile(test_other="def test_other(): assert False")
    result = pytester.runpytest(
        "--odkit-conform", "bench:gxmm", "--odkit-eds", EDS, "--odkit-node-id", "5", "--odkit-only", "nmt-s*", "-v"
    )
    outcomes = result.parseoutcomes()
    assert outcomes["passed"] >= 3 and set(outcomes) <= {"passed", "skipped"}
    result.stdout.fnmatch_lines(["*nmt-start[[]CiA 301*] PASSED*"])
    result = pytester.runpytest("--odkit-conform", "bench:gxmm", "--odkit-only", "nmt-start", "test_other.py")
    result.assert_outcomes(passed=1, failed=1)


def test_the_link_of_a_conformance_test_is_closed(pytester):
    with socket.create_server(("127.0.0.1", 0)) as server:
        link = f"slcan:127.0.0.1:{server.getsockname()[1]}"
        pytester.runpytest("--odkit-conform", link, "--odkit-eds", EDS, "--odkit-only", "drive-objects").assert_outcomes(skipped=1)
        adapter, _ = server.accept()
        adapter.settimeout(10)
        # The end of the connection comes after the commands that were sent.
        while adapter.recv(100):
            pass


def test_a_case_that_fails_says_why(pytester):
    with open(EDS) as file:
        wrong = file.read().replace("DefaultValue=0x20196", "DefaultValue=0x10196", 1)
    (pytester.path / "wrong.eds").write_text(wrong)
    result = pytester.runpytest(
        "--odkit-conform", "bench:gxmm", "--odkit-eds", "wrong.eds", "--odkit-only", "eds-device-type"
    )
    result.assert_outcomes(failed=1)
    result.stdout.fnmatch_lines(["*expected*", "*odkit bus log*", "*601#40001000*"])
    result = pytester.runpytest("--odkit-conform", "slcan:127.0.0.1:1")
    result.stderr.fnmatch_lines(["*add --odkit-eds FILE*"])


def test_tests_with_long_or_equal_names_are_recorded(pytester):
    pytester.makepyfile(
        """
        import pytest

        @pytest.mark.parametrize("text", ["a/b", "a-b", "a:b", "x" * 400, "x" * 400 + "y"])
        def test_it(text, odkit_bench):
            odkit_bench.run(0.1)
        """
    )
    pytester.runpytest("--odkit-record", "logs").assert_outcomes(passed=5)
    logs = [path.name for path in (pytester.path / "logs").iterdir()]
    assert len(logs) == 5 and all(len(name) < 200 for name in logs)


def test_a_failing_fixture_shows_its_frames(pytester):
    pytester.makepyfile(
        """
        import pytest

        @pytest.fixture
        def started(odkit_bench):
            assert odkit_bench["gxmm"].state == "Operational"

        @pytest.fixture
        def stopped(odkit_bench):
            yield
            assert odkit_bench["gxmm"].state == "Stopped"

        def test_first(started): ...
        def test_second(stopped): ...
        """
    )
    result = pytester.runpytest()
    result.assert_outcomes(errors=2, passed=1)
    result.stdout.fnmatch_lines(["*odkit bus log*", "0.000000 <- 701#00*", "*odkit bus log*", "0.000000 <- 701#00*"])
